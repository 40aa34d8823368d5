/* A point of a region that moves as the drawing does, for slices through time. */
#ifndef FLUIDY_INSPECT_FOLLOWED_POINT_H
#define FLUIDY_INSPECT_FOLLOWED_POINT_H

#include "base/rect.h"
#include "guides/guides.h"

/** Where the point is in a frame. */
typedef struct FlFollowedPoint {
    bool here;  // the region is in the frame, else the rest means nothing
    bool found; // anew, since the caller last cleared it: nothing of the frame before led to it
    float x, y; // px of the frame
    float turn; // of the drawing around it since it was found, turns, clockwise
} FlFollowedPoint;

/**
 * Moves the point into the next painted frame, whose guides of `rect` these are: along the
 * drawing's motion where that is known, else along the flow. A point that was not there, or that
 * nothing moves along with, is put where the region is deepest.
 */
void fl_followed_point_move(FlFollowedPoint *point, FlRect rect, const FlGuides *guides);

#endif
