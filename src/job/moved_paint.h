/* Paint of another engine whose ink a tile then moves: --tile. */
#ifndef FLUIDY_JOB_MOVED_PAINT_H
#define FLUIDY_JOB_MOVED_PAINT_H

#include "job/engine.h"
#include "job/style_cache.h"

/**
 * Chooses the engine of a region: fl_engine_choose(), or with settings->tile one that wraps it and
 * moves its paint by the tile of that style.
 *
 * *tile: borrowed from `styles`; NULL without settings->tile. texture_px: see fl_style_cache_get().
 *
 * Returns: NULL with FL_ERROR_STYLE, FL_ERROR_USAGE or FL_ERROR_NO_MEMORY set.
 */
const FlEngine *fl_engine_of_region(FlStyleCache *styles, const FlStyleInstance *style,
                                    const FlRegionSettings *settings, float texture_px,
                                    const FlStyleInstance **tile, GError **error);

#endif
