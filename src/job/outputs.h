/* The files that a render writes, and the guard against overwriting those that it reads. */
#ifndef FLUIDY_JOB_OUTPUTS_H
#define FLUIDY_JOB_OUTPUTS_H

#include "job/plan.h"

/** True if a frame has a picture of its own, which fl_frame_files() then names first. */
bool fl_frame_has_picture(const FlPlan *plan);

/**
 * Names the files of a frame: picture, layers, and the paint of regions that have a new picture.
 *
 * Returns: to be freed with g_ptr_array_unref(); NULL with FL_ERROR_USAGE.
 */
GPtrArray *fl_frame_files(const FlPlan *plan, int frame, GError **error);

/**
 * Checks that no output file is one of plan->inputs, under any name, even if files may be
 * overwritten.
 *
 * Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_inputs(const FlPlan *plan, GError **error);

/**
 * Checks the same for pictures that are not painted: maps, flats and sheets. pattern: their name,
 * with a frame number or without. Styles that a config names are not looked at.
 *
 * Returns: false with FL_ERROR_USAGE set, naming the file.
 */
bool fl_guard_pictures(const FlDrawing *drawing, const FlRenderOptions *options,
                       const char *pattern, GError **error);

/**
 * Writes options.provenance, unless it is NULL: the facts that decide the frames, in words, and the
 * SHA-256 of each file that was written. Returns: false with FL_ERROR_OUTPUT set.
 */
bool fl_write_provenance(const FlPlan *plan, GError **error);

#endif
