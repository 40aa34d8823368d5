/* A draw list that waits for its frame: coverage is the same over long runs, and packs well. */
#ifndef FLUIDY_DRAWING_PACKED_DRAWS_H
#define FLUIDY_DRAWING_PACKED_DRAWS_H

#include "drawing/drawing.h"

typedef struct FlPackedDraws FlPackedDraws;

/** Takes the list over, also on failure. Returns: NULL with FL_ERROR_NO_MEMORY set. */
FlPackedDraws *fl_packed_draws_new(FlDrawList *draws, GError **error);
void fl_packed_draws_free(FlPackedDraws *packed); // NULL is fine

/** Gives the list back, and frees what it was packed in, also on failure. Returns: NULL with
 * FL_ERROR_NO_MEMORY set. */
FlDrawList *fl_packed_draws_open(FlPackedDraws *packed, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPackedDraws, fl_packed_draws_free)

#endif
