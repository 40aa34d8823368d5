/* Which regions are ever seen: what others lie over in every frame needs no paint. */
#ifndef FLUIDY_JOB_SIGHT_H
#define FLUIDY_JOB_SIGHT_H

#include "job/shared_edges.h"

/** What lies over what, in frames of width * height. */
typedef struct FlSight {
    const FlJoin *joins; // by region: only FL_JOIN_CLOSED knocks out all that is below it
    int width, height;
    int rim_px; // how far inside its contour a shape hides everything, fl_knockout()
} FlSight;

/**
 * Sets seen[region], atomically, for the regions of a frame of which something shows: the others
 * lie wholly below opaque shapes, inside their rims. Regions that are known to be seen cost
 * nothing. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_sight_note(const FlSight *sight, const FlDrawList *draws, bool *seen, GError **error);

#endif
