/* A film as the options and the config ask for it. */
#ifndef FLUIDY_DRAWING_OPEN_DRAWING_H
#define FLUIDY_DRAWING_OPEN_DRAWING_H

#include "drawing/drawing.h"
#include "params/config.h"

/**
 * Opens the film of options, which fl_config_complete() has completed, with the config's rules.
 *
 * What is odd, sections that hold for nothing included, goes to options->warning.
 *
 * Returns: to be freed with fl_drawing_free(); NULL with an error as of fl_drawing_open(), or with
 * FL_ERROR_INPUT if there was a warning and the options are strict.
 */
FlDrawing *fl_drawing_from_options(const FlRenderOptions *options, const FlConfig *config,
                                   GError **error);

#endif
