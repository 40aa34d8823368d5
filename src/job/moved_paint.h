/* Paint of another engine whose ink a tile then moves: --tile. */
#ifndef FLUIDY_JOB_MOVED_PAINT_H
#define FLUIDY_JOB_MOVED_PAINT_H

#include "job/engine.h"
#include "job/style_cache.h"

/**
 * The engine of a region that is painted with a style: fl_engine_choose(), or around that the one
 * that moves its paint by the tile of another style, *tile, borrowed from the cache; NULL: none.
 * texture_px: as of fl_style_cache_get().
 *
 * Returns: NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlEngine *fl_engine_of_region(FlStyleCache *styles, const FlStyleInstance *style,
                                    const FlRegionSettings *settings, float texture_px,
                                    const FlStyleInstance **tile, GError **error);

#endif
