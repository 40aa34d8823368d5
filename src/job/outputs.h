/* The files that a render writes, and the guard against overwriting those that it reads. */
#ifndef FLUIDY_JOB_OUTPUTS_H
#define FLUIDY_JOB_OUTPUTS_H

#include "io/sink.h"
#include "job/region_plan.h"
#include "keep/facts.h"
#include "keep/inputs.h"

/** The outputs of a render. */
typedef struct FlOutputs {
    char *output; // pattern or file; of what an interrupted run leaves if parts_only
    const FlSinkFormat *format;
    char *movie; // the film made of the frames; may be NULL
    const FlSinkFormat *movie_format;
    bool parts_only;   // layers or paint are written, but no frames
    int part, n_parts; // of a merge, `part` from 0
    int first, end;    // the frames of this run, up to and without `end`
    /* Of the options, whose texts are borrowed. */
    const char *layers, *paint, *stats, *provenance, *report, *dump, *ebsynth;
    FlPaintArea paint_area;
    FlOverwrite overwrite;
    bool merge, thickness;
    double fps;
    const char *audio;
    double audio_from;
} FlOutputs;

/** The frames, of so many, that a part of a merge composes. */
void fl_outputs_part(const FlOutputs *out, int n_frames, int *first, int *end);

/** True if a frame has a picture of its own, which fl_frame_files() then names first. */
bool fl_frame_has_picture(const FlOutputs *out);

/**
 * Names the files of a frame: picture, layers, and the paint of regions that have a new picture.
 *
 * Returns: to be freed with g_ptr_array_unref(); NULL with FL_ERROR_USAGE.
 */
GPtrArray *fl_frame_files(const FlOutputs *out, const FlShapes *shapes, int frame, GError **error);

/** The digest of all that decides a film: what decides its frames, its format and speed. */
FlDigest fl_film_digest(const FlOutputs *out, FlDigest made_from);

/**
 * Checks that no output file is one of the inputs, under any name, even if files may be
 * overwritten.
 *
 * Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_inputs(const FlOutputs *out, const FlShapes *shapes, FlInputs *inputs,
                     GError **error);

/**
 * Writes out->provenance: the facts that decide the frames, in words, and the
 * SHA-256 of each file that was written. Returns: false with FL_ERROR_OUTPUT set.
 */
bool fl_write_provenance(const FlOutputs *out, const FlShapes *shapes, const FlFacts *facts,
                         GError **error);

#endif
