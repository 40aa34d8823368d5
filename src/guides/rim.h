/* The depth for the synthesis: a rim as wide as the shape allows. */
#pragma once

#include "base/rect.h"

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A shape, of one frame of width * height pixels. */
typedef struct FlRimShape {
    int width, height;
    const uint8_t *mask;     // its coverage
    const float *distance;   // to its contour, fl_distance()
    const uint8_t *together; // coverage of the mask and all shapes like it, between which there is
                             // no rim; NULL: no other shape is like this one
    const uint8_t *seen;     // coverage of their visible parts; NULL: all are visible
    const uint8_t *shown;    // coverage of all shapes of the frame; NULL: there are no others
} FlRimShape;

/**
 * The depth of each pixel of the shape for the paint, px: below border_px, or equal to `distance`.
 *
 * Where the shape is at least two borders wide this is the distance to the contour. A narrower part
 * gets a narrower rim with core paint amid it, and one that is hardly there gets none: it is
 * treated as cut out of the middle of a larger one. How the rim narrows depends on what is seen
 * beyond the contour: over other shapes details stay crisp, beside paper tapers thin out evenly.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_rim_depth(const FlRimShape *shape, float border_px, float *depth, GError **error);
