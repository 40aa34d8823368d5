/* Draw lists that wait or travel: coverage is the same over long runs, and packs well. */
#ifndef FLUIDY_DRAWING_PACKED_DRAWS_H
#define FLUIDY_DRAWING_PACKED_DRAWS_H

#include "drawing/drawing.h"

/** The list stays the caller's. Returns: NULL with FL_ERROR_NO_MEMORY set. */
GBytes *fl_draws_pack(const FlDrawList *draws, GError **error);

/**
 * The list anew. `packed` need not be trusted: it has at most `most` draws, all of regions of this
 * drawing and within its picture.
 *
 * Returns: NULL with FL_ERROR_NO_MEMORY set, or FL_ERROR_INPUT: it is damaged.
 */
FlDrawList *fl_draws_unpack(GBytes *packed, const FlDrawing *drawing, int most, GError **error);

#endif
