/* Knockout: the share of what lies below a shape that its paint replaces. */
#pragma once

#include "base/rect.h"
#include "params/region_settings.h"

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * Sets knockout, 0..255 per pixel with coverage: at the contour it rises with the amount of paint,
 * from nothing at a fifth of the median to 255 at three fifths, so that a rim fades into the paint
 * below; with `white`, 0..1, at 1 it rises from 0 to a fifth. Amid the shape it is 255 from three
 * tenths on, since there paper shows: paint below went around the shape. Holes show the paint below
 * all the same. One becomes the other within radius_px (>= 1) of the contour, as the share of the
 * shape in a square around the pixel rises.
 * Thin places of an opaque medium show it everywhere, the more the darker the fill is than the
 * paper, 0..255; those of FL_MEDIUM_BODY amid no shape.
 *
 * amounts, coverage and shown are of a box in a frame of width * height, whose sides are no
 * contour. shown: coverage, or 0 where knockout does not matter and may stay as it is.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_knockout(const int16_t *amounts, const uint8_t *coverage, const uint8_t *shown, FlRect box,
                 int width, int height, int radius_px, FlMedium medium, int darkness, float white,
                 uint8_t *knockout, GError **error);
