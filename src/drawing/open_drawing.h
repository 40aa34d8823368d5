/* Opens the drawing with the options and the rules of the config. */
#ifndef FLUIDY_DRAWING_OPEN_DRAWING_H
#define FLUIDY_DRAWING_OPEN_DRAWING_H

#include "base/error.h"
#include "drawing/drawing.h"
#include "params/config.h"

/**
 * Opens the drawing of options, which fl_config_complete() has completed, with the config's rules.
 *
 * Warnings, also of sections that match no region, go to the caller.
 *
 * Returns: to be freed with fl_drawing_free(); NULL with an error as of fl_drawing_open(), or with
 * FL_ERROR_INPUT if there was a warning and the options are strict.
 */
FlDrawing *fl_drawing_from_options(const FlRenderOptions *options, const FlConfig *config,
                                   const FlCaller *caller, GError **error);

/**
 * The frames that the options name, found by their files' names; the files are not read.
 *
 * Returns: to be freed with fl_sequence_free(); NULL with FL_ERROR_USAGE or FL_ERROR_INPUT.
 */
FlSequence *fl_sequence_from_options(const FlRenderOptions *options, GError **error);

#endif
