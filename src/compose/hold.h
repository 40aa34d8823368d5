/* Regions on twos in a film on ones: a frame with some of its regions as they were before. */
#ifndef FLUIDY_COMPOSE_HOLD_H
#define FLUIDY_COMPOSE_HOLD_H

#include "job/plan.h"

/**
 * The runs that a frame shows: those of the frame that the film holds; of a painted region with a
 * hold of its own those of the frame in which it was last painted, stacked where its runs are now,
 * else above the region that they lay on.
 *
 * Returns: to be freed with fl_draw_list_free(); NULL with an error.
 */
FlDrawList *fl_hold_draw_list(const FlPlan *plan, int frame, GError **error);

#endif
