/* The work of a worker: from the bytes of a request to those of its answer. */
#pragma once

#include "worker/messages.h"

/** State between requests. Zero is the empty state. */
typedef struct FlServant {
    FlSvg *measured;     // the frame that was measured last
    char *file;          // its file
    FlSvgOptions svg;    // its options; `whole` is NULL
    FlWarnings *remarks; // about it
} FlServant;

void fl_servant_clear(FlServant *servant);

/** Answers a request, an error included. `bytes` are a host's, and are only checked. */
GByteArray *fl_serve(FlServant *servant, const void *bytes, size_t n);

/**
 * Answers FL_VERB_SURVEY. Groups that look different when they are drawn shape by shape are added
 * to those that are drawn as one. `svg` is the frame if it is open, and is freed; else NULL.
 *
 * Returns: false with an error, which names the file. The frame is to be cleared either way.
 */
bool fl_survey_frame(const FlRequest *request, FlSvg *svg, FlSurveyFrame *frame, FlStrings *strings,
                     FlWarnings *warnings, GError **error);

bool fl_has_group(char **groups, const char *group); // NULL: none

/** Makes one more group or shape of a frame one leaf. */
void fl_keep_whole(FlSurveyFrame *frame, const char *group);

/** Answers FL_VERB_DRAW. Returns: NULL with an error. */
FlDrawList *fl_draw_frame(const FlRequest *request, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlServant, fl_servant_clear)
