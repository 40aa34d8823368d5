/* The shape of what is cut out: its alpha without holes, and full where it is thin all over. */
#ifndef FLUIDY_LAZY_FLUID_SHAPE_H
#define FLUIDY_LAZY_FLUID_SHAPE_H

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * Raises alpha, width * height of 0 … 1, until no pixel is lower than the lowest way out of the
 * frame from it, and then so far that the mean of what is at least half covered is one. Holes and
 * what shines through are texture of the interior; blurred alpha alone, by which [L15 §4.2] tells
 * interior from boundary, would show them along contours only.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_fluid_shape(float *alpha, int width, int height, GError **error);

#endif
