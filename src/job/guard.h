/* A render must not overwrite its own input. */
#ifndef FLUIDY_JOB_GUARD_H
#define FLUIDY_JOB_GUARD_H

#include "job/plan.h"

/**
 * The paths of everything that a render may read: drawings and what they refer to, the config,
 * backgrounds, flow, paint to be merged, styles with their folders. Not all of them need exist.
 *
 * Returns: strings in a fixed order, to be freed with g_ptr_array_unref().
 */
GPtrArray *fl_guard_list_inputs(const FlPlan *plan);

/**
 * Checks that no output file is an input: a drawing, also of another frame, or what it refers to,
 * the config, a background, a flow, paint to be merged, or a file of a style; under any name, and
 * even if files may be overwritten.
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

#endif
