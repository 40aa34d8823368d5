/* Which regions are ever seen: what others lie over in every frame needs no paint. */
#ifndef FLUIDY_JOB_VISIBLE_REGIONS_H
#define FLUIDY_JOB_VISIBLE_REGIONS_H

#include "job/shared_edges.h"

/** What lies over what, in frames of width * height. */
typedef struct FlVisibleRegions {
    const FlJoin *joins; // by region: only FL_JOIN_CLOSED knocks out all that is below it
    int width, height;
    int rim_px; // how far inside its contour a shape hides everything, fl_knockout()
} FlVisibleRegions;

/**
 * Sets seen[region], atomically, for the regions of a frame of which something shows: the others
 * lie wholly below opaque shapes, inside their rims. Regions that are known to be seen cost
 * nothing. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_visible_regions_note(const FlVisibleRegions *visible, const FlDrawList *draws, bool *seen,
                             GError **error);

#endif
