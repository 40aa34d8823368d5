/* The files that a render writes, and the guard against overwriting those that it reads. */
#pragma once

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

/* ---- the paint of regions as files ----------------------------------------------------------- */

/** The file of a region's paint that ebsynth writes, below the folder of --ebsynth. */
#define FL_EBSYNTH_OUTPUT "{region}/out_%04d.png"

/**
 * The file of a region's paint in a frame; held frames share the file of the first.
 *
 * Returns: to be freed with g_free(); NULL with FL_ERROR_USAGE.
 */
char *fl_paint_file_name(const char *pattern, const FlDrawing *drawing, const FlRegionPlan *region,
                         int frame, GError **error);

/**
 * Writes the paint of a region, in the exemplar's colours, as PNG: as large as the frame, or as
 * painted->rect, with its place. mark: see fl_mark_text().
 */
bool fl_paint_file_save(const FlPaintedRegion *painted, FlPaintArea area, const char *path,
                        const char *mark, bool overwrite, GError **error);

/** Sets region->place if the file of its paint in the first frame exists and has a place. */
void fl_paint_file_find_place(const FlDrawing *drawing, FlRegionPlan *region);

/** Reads the part painted->rect of such a file, or one that has that part alone. FL_ERROR_INPUT. */
bool fl_paint_file_load(FlPaintedRegion *painted, const char *path, GError **error);
