/* Holes in paint: what of its thin places belongs to its rim, and what does not. */
#ifndef FLUIDY_COMPOSE_HOLES_H
#define FLUIDY_COMPOSE_HOLES_H

#include "base/rect.h"

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * Gives full body to thin places that no thin way joins to the contour. Paint below runs on under a
 * soft rim; in a hole amid the paint, paper shows, for the paint above went around nothing.
 *
 * body, one per pixel of the area's box, is that of fl_colourise_knockout(): thin is less than 255.
 * coverage, of the same pixels, is 0 beyond the area; the contour is where it is less than 255, and
 * the side of the box.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_holes_close(uint8_t *knockout, const uint8_t *coverage, const FlArea *area, GError **error);

#endif
