/* Regions on twos in a film on ones: a frame with some of its regions as they were before. */
#ifndef FLUIDY_RENDER_HELD_H
#define FLUIDY_RENDER_HELD_H

#include "render/plan.h"

/**
 * The runs that a frame shows: those of the frame that the film holds; of a painted region with a
 * hold of its own those of the frame in which it was last painted, stacked where its runs are now,
 * else above the region that they lay on.
 *
 * Returns: to be freed with fl_runs_free(); NULL with an error.
 */
FlRuns *fl_held_runs(const FlPlan *plan, int frame, GError **error);

#endif
