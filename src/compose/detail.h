/* Small details: what of a shape is hardly more than rim. */
#ifndef FLUIDY_COMPOSE_DETAIL_H
#define FLUIDY_COMPOSE_DETAIL_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * How far each connected part of what is seen of a shape is a small detail, such as an eye or the
 * side of a tile, 0..255: wholly if it is nowhere wider than 5/4 of radius_px, not at all if it is
 * as wide as 11/8 of it somewhere, for between the two it has a pale band around. The ends of a
 * leaf are no details, however narrow: their paint has the rim that it has all around.
 *
 * seen and detail are width * height; seen is 255 where the shape is seen, else 0. Pixels beside a
 * part, at its contour, have its value too.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_detail_find(const uint8_t *seen, int width, int height, int radius_px, uint8_t *detail,
                    GError **error);

#endif
