/* Regions on twos in a film on ones: a frame with some of its regions as they were before. */
#ifndef FLUIDY_DRAWING_HOLD_H
#define FLUIDY_DRAWING_HOLD_H

#include "drawing/drawing.h"

/**
 * The draw list that a frame shows: that of the frame which the film holds; of a region with a hold
 * of its own what it had in the frame in which it was last painted, stacked where it is drawn now,
 * else above the region that it lay on.
 *
 * hold: of the film, frames. hold_of: of each region; the film's where it has none of its own.
 * Returns: to be freed with fl_draw_list_free(); NULL with an error.
 */
FlDrawList *fl_hold_draw_list(const FlDrawing *drawing, int hold, const int *hold_of, int frame,
                              GError **error);

#endif
