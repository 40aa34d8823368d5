/* The parts of a mask that rest while others move. */
#ifndef FLUIDY_GUIDES_RESTING_PARTS_H
#define FLUIDY_GUIDES_RESTING_PARTS_H

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_REST_PX 8 // side of a square

/** The state of a mask in a square, now or in the frame before. */
enum { FL_SQUARE_TAKEN = 1, FL_SQUARE_CHANGES = 2 };

/** The parts at rest, by squares of FL_REST_PX px. Parts are at least two squares apart, so that no
 * patch of one looks at another on any but the coarsest levels. */
typedef struct FlRestingParts {
    int width, height; // of the frame, px
    int columns, rows;
    bool *keeps; // by square: a part at rest is in or beside the square; NULL: no part rests
} FlRestingParts;

/** The number of squares along a side. */
static inline int fl_rest_squares(int px)
{
    return (px + FL_REST_PX - 1) / FL_REST_PX;
}

/**
 * Finds the parts without a square that changes. square: FL_SQUARE_TAKEN and FL_SQUARE_CHANGES of
 * all squares, row by row. moving: becomes the rectangle of the others, in px. FL_ERROR_NO_MEMORY.
 */
bool fl_resting_parts_init(FlRestingParts *parts, int width, int height, const uint8_t *square,
                           FlRect *moving, GError **error);

void fl_resting_parts_clear(FlRestingParts *parts);

/** A stretch of row y from column x on, all inside squares that parts at rest keep, or all outside.
 * *end: its end. Returns: true if the stretch is kept. */
bool fl_resting_parts_stretch(const FlRestingParts *parts, int x, int y, int *end);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRestingParts, fl_resting_parts_clear)

#endif
