/* The notes at the end of a render. */
#ifndef FLUIDY_RENDER_SUMMARY_H
#define FLUIDY_RENDER_SUMMARY_H

#include "inspect/stats.h"
#include "job/plan.h"

/** Notes what was painted, the time by stage, and the report's path. */
void fl_summary_of_render(const FlPlan *plan, const FlStats *stats);

/** Notes what would be painted, and an estimate of the time at frame_s seconds a frame. */
void fl_summary_of_dry_run(const FlPlan *plan, double frame_s);

#endif
