/* Regions on twos in an animation on ones: frames in which some regions show an earlier frame. */
#ifndef FLUIDY_DRAWING_HOLD_H
#define FLUIDY_DRAWING_HOLD_H

#include "drawing/drawing.h"

/**
 * The draw list that a frame shows: that of the frame that is held. A region with a hold of its own
 * has the draws of the frame in which it was last painted, at the place in the stack of its present
 * draws, else above the region that it lay on.
 *
 * hand: NULL: plain. hold: of the film, frames. hold_of: of each region; the film's where it has
 * none of its own. Returns: to be freed with fl_draw_list_free(); NULL with an error.
 */
FlDrawList *fl_hold_draw_list(const FlDrawing *drawing, const FlHand *hand, int hold,
                              const int *hold_of, int frame, GError **error);

#endif
