/* Paint that later renders take instead of painting it again: a folder of files named by digests.
 */
#ifndef FLUIDY_JOB_PAINT_CACHE_H
#define FLUIDY_JOB_PAINT_CACHE_H

#include "base/compress.h"
#include "base/digest.h"
#include <fluidy/render.h>

/**
 * A cache in use. Any thread, and several processes with one folder: files appear whole or not at
 * all, and what another process removes is painted again. Nothing of it is an error: the first
 * thing that is wrong is a warning of the options, when fl_paint_cache_warn() is called.
 */
typedef struct FlPaintCache FlPaintCache;

/** What is kept; a digest names one thing of each kind. */
typedef enum FlCacheKind {
    FL_CACHE_PICTURE, // of a region: its paint, and the state of its engine
    FL_CACHE_FILM,    // the digests of all pictures of a region
    FL_CACHE_RENDER,  // what a render has read and written
    FL_CACHE_FACTS,   // what decided the paint of a region when it was last painted
} FlCacheKind;

/** The cache of options->cache; options must outlive it. Returns: NULL: there is none. */
FlPaintCache *fl_paint_cache_open(const FlRenderOptions *options);

/** Removes what was used least recently until the limit is met. NULL is fine. */
void fl_paint_cache_close(FlPaintCache *cache);

/** Whether there is a file, which may still be damaged. */
bool fl_paint_cache_has(const FlPaintCache *cache, FlCacheKind kind, FlDigest name);

/** Returns: to be freed with g_bytes_unref(); NULL: it is missing, or was damaged and is gone. */
GBytes *fl_paint_cache_get(FlPaintCache *cache, FlCacheKind kind, FlDigest name);

/** Keeps the parts in a row. Where that cannot be done, the rest of the render keeps nothing. */
void fl_paint_cache_put(FlPaintCache *cache, FlCacheKind kind, FlDigest name, const FlSpan *parts,
                        int n);

void fl_paint_cache_drop(FlPaintCache *cache, FlCacheKind kind, FlDigest name);

/** Warns of what was wrong since the last call; from the thread that the options want. */
void fl_paint_cache_warn(FlPaintCache *cache);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPaintCache, fl_paint_cache_close)

#endif
