/* The local width of a shape at each of its pixels. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_WIDTH_ONE 16      /**< half widths are in sixteenths of a pixel */
#define FL_WIDTH_MOST_PX 256 /**< the widest that is told apart */

/** The distance outside up to which there are half widths: patches of pixels inside reach two
 * pixels out, and far more on coarse levels. */
#define FL_WIDTH_OUTSIDE_PX 12

/** The half width of a shape that is as wide as is ever asked for, cap_px. */
static inline uint16_t fl_width_cap(float cap_px)
{
    const float cap = cap_px * FL_WIDTH_ONE + 0.5f, most = FL_WIDTH_MOST_PX * FL_WIDTH_ONE;
    return (uint16_t)(cap < 1.0f ? 1.0f : cap > most ? most : cap);
}

/**
 * Half the local width: the radius of the largest disc inside the shape that holds the pixel, at
 * most fl_width_cap(cap_px). It grows by at most 7/4 px a px, so that the mouth of a limb has the
 * limb's width and not its body's, and is smoothed within the shape. Pixels outside have that of
 * the shape next to them up to FL_WIDTH_OUTSIDE_PX from it, then 0.
 *
 * Discs are scaled by the visibility of their centre, 0..255 in `seen`: a ring around a covering
 * shape is as narrow as it looks. NULL: all of the shape is seen.
 *
 * distance, seen and half_width are width * height; distance is from fl_distance(), positive
 * inside. *narrow: true if a half width inside is below the cap.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_local_width(const float *distance, const uint8_t *seen, int width, int height, float cap_px,
                    uint16_t *half_width, bool *narrow, GError **error);

/** The same before it is limited and smoothed; 0 outside. */
bool fl_largest_discs(const float *distance, const uint8_t *seen, int width, int height,
                      float cap_px, uint16_t *radius, GError **error);
