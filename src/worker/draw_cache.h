/* Draws of a frame, for the next one: what rests is drawn once. */
#ifndef FLUIDY_WORKER_DRAW_CACHE_H
#define FLUIDY_WORKER_DRAW_CACHE_H

#include "base/frame_cache.h"
#include "worker/draw_frame.h"

/** The bytes of what is drawn. */
size_t fl_draw_bytes(const FlDraw *draw);

/** Copies what no hand has drawn. FL_ERROR_NO_MEMORY; clear the copy then as well. */
bool fl_draw_copy(const FlDraw *draw, FlDraw *copy, GError **error);

/** The draw of that digest; NULL: there is none. */
const FlDraw *fl_draw_cache_find(FlFrameCache *cache, FlDigest digest);

/**
 * Keeps a copy of a draw whose digest is known, while there is room beside the `bytes` that the
 * frame has kept, and adds its own. FL_ERROR_NO_MEMORY.
 */
bool fl_draw_cache_keep(FlFrameCache *cache, FlDigest digest, const FlDraw *draw, size_t *bytes,
                        GError **error);

#endif
