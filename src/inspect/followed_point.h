/* A point of a region that moves as the drawing does, for slices through time. */
#ifndef FLUIDY_INSPECT_FOLLOWED_POINT_H
#define FLUIDY_INSPECT_FOLLOWED_POINT_H

#include "base/rect.h"
#include "guides/guides.h"

/** The position of the point in a frame. */
typedef struct FlFollowedPoint {
    bool here;  // the region is in the frame, else the other fields are undefined
    bool found; // placed anew since the caller last cleared this flag: no motion led here
    float x, y; // px of the frame
    float turn; // of the drawing around it since it was found, turns, clockwise
} FlFollowedPoint;

/**
 * Moves the point into the next painted frame, whose guides of `rect` these are: along the
 * drawing's motion where that is known, else along the flow. A point that was absent, or from which
 * no pixel came, is placed at the deepest pixel of the region.
 */
void fl_followed_point_move(FlFollowedPoint *point, FlRect rect, const FlGuides *guides);

#endif
