/* The styles of a render: each is read and packed once for all regions that share it. */
#ifndef FLUIDY_JOB_STYLE_CACHE_H
#define FLUIDY_JOB_STYLE_CACHE_H

#include "compose/painted_region.h"

/** All of them; what fl_style_cache_get() hands out stays until _free. */
typedef struct FlStyleCache FlStyleCache;

FlStyleCache *fl_style_cache_new(void);
void fl_style_cache_free(FlStyleCache *cache); // NULL is fine

/**
 * The style of a region, whose settings name one.
 *
 * Returns: borrowed; NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlStyleInstance *fl_style_cache_get(FlStyleCache *cache, const FlRegionSettings *settings,
                                          GError **error);

/** About how many bytes they take. */
double fl_style_cache_bytes(const FlStyleCache *cache);

/**
 * Moves the windows of long recordings to where they are for a frame of a film of n_frames frames.
 * Nobody may paint meanwhile. Returns: false with FL_ERROR_INPUT or FL_ERROR_NO_MEMORY set.
 */
bool fl_style_cache_seek(FlStyleCache *cache, int frame, int n_frames, bool loops, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleCache, fl_style_cache_free)

#endif
