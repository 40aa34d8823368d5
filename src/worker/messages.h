/* Requests to workers and their answers: the one wire format between host and worker. */
#pragma once

#include "base/reader.h"
#include "base/warnings.h"
#include "svg/inner_frames.h"
#include "worker/draws.h"
#include "worker/frame_parts.h"

typedef enum FlVerb {
    FL_VERB_COUNT,    // the frames in a file: layers, pages, moments
    FL_VERB_MEASURE,  // the page of a frame, and the place of its shapes on the page
    FL_VERB_SURVEY,   // the parts of a frame
    FL_VERB_OUTLINES, // the outlines of its leaves
    FL_VERB_DRAW,     // its draw list
    FL_N_VERBS,
} FlVerb;

/** A request; its pointers are borrowed, but for one that was unpacked. */
typedef struct FlRequest {
    FlVerb verb;
    const char *file;
    int number;        // of the frame, as in the file's name
    int frame;         // its index in the film
    FlSvgOptions svg;  // how it is read
    FlPageSize page;   // OUTLINES, DRAW: px of the picture
    FlMoments moments; // COUNT: that are wanted, if svg.from is TIME
    double scale;      // SURVEY: px of the picture per px of the drawing
    int width, height; // SURVEY, DRAW: of the picture
    bool shapes;       // MEASURE: are wanted
    int n_regions;     // DRAW: of the film
    int n_steps;       // DRAW
    const FlDrawStep *step;
    const FlHand *hand;  // DRAW; NULL: plain
    const uint64_t *key; // of each region's hand
} FlRequest;

/** Appends a request. */
void fl_request_pack(const FlRequest *request, GByteArray *out);

/**
 * Reads a request; `hand` holds what it points to. The bytes must outlive it. Returns: false if
 * they are damaged; it is to be cleared either way.
 */
bool fl_request_unpack(FlReader *reader, FlRequest *request, FlHand *hand);
void fl_request_clear(FlRequest *request);

/** An answer begins with 0, or with 1 + the code of an error and its text. */
void fl_answer_pack_error(GByteArray *out, const GError *problem);

/** Returns: true if an answer follows; else false with the worker's error, or FL_ERROR_INPUT. */
bool fl_answer_begin(FlReader *reader, const char *file, GError **error);

/** Sets FL_ERROR_INPUT: what a worker answered about a file is damaged. Returns: false. */
bool fl_answer_set_damaged(const char *file, GError **error);

/** The answer of FL_VERB_MEASURE. */
typedef struct FlPageMeasures {
    double width, height; // px of the page
    GArray *shapes;       // FlShape; empty where they are not wanted
} FlPageMeasures;

/** The answer to FL_VERB_COUNT. */
void fl_inner_frames_pack(const FlInnerFrames *frames, GByteArray *out);
bool fl_inner_frames_unpack(FlReader *reader, FlInnerFrames *frames);

void fl_measures_pack(const FlPageMeasures *measures, GByteArray *out);
bool fl_measures_unpack(FlReader *reader, FlPageMeasures *measures);

/** The answer of FL_VERB_SURVEY, without `canvas`. */
void fl_survey_pack(const FlSurveyFrame *frame, const FlStrings *strings,
                    const FlWarnings *warnings, GByteArray *out);

/** Reads a frame and adds its strings and warnings; `warnings` may be NULL. Returns: false if the
 * bytes are damaged; the frame is to be cleared either way. */
bool fl_survey_unpack(FlReader *reader, FlSurveyFrame *frame, FlStrings *strings,
                      FlWarnings *warnings);

/** A draw list as bytes: coverage is the same over long runs, and packs well. The list stays the
 * caller's. Returns: NULL with FL_ERROR_NO_MEMORY set. */
GBytes *fl_draws_pack(const FlDrawList *draws, GError **error);

/** The limits that a draw list must keep to. */
typedef struct FlDrawBounds {
    int width, height, n_regions;
    int most; // draws
} FlDrawBounds;

/**
 * The list anew; the bytes need not be trusted. All draws are of regions within the bounds, and
 * their rows within the picture, from `first` to no less.
 *
 * Returns: NULL with FL_ERROR_NO_MEMORY set, or FL_ERROR_INPUT: it is damaged.
 */
FlDrawList *fl_draws_unpack(const void *packed, size_t bytes, const FlDrawBounds *bounds,
                            GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRequest, fl_request_clear)
