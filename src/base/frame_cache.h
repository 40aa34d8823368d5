/* Keeps the results of a frame for the next frame, which shares most of them. */
#ifndef FLUIDY_BASE_FRAME_CACHE_H
#define FLUIDY_BASE_FRAME_CACHE_H

#include "base/digest.h"
#include <glib.h>

/** For one thread; zero is an empty one. */
typedef struct FlFrameCache {
    GHashTable *last, *now; // FlDigest -> GArray: of the frame before, and of this one
} FlFrameCache;

void fl_frame_cache_clear(FlFrameCache *cache);

/** The array that is kept for a digest, owned by the cache; NULL if absent, or if the digest is
 * zero. */
const GArray *fl_frame_cache_find(FlFrameCache *cache, FlDigest digest);

/** Keeps things for this frame and the next; the cache owns them then. */
void fl_frame_cache_keep(FlFrameCache *cache, FlDigest digest, GArray *things);

/** Begins another frame: forgets what this one has neither asked for nor kept. */
void fl_frame_cache_next_frame(FlFrameCache *cache);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFrameCache, fl_frame_cache_clear)

#endif
