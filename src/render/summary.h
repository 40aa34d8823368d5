/* The notes at the end of a render. */
#ifndef FLUIDY_RENDER_SUMMARY_H
#define FLUIDY_RENDER_SUMMARY_H

#include "inspect/stats.h"
#include "render/painters.h"

/** Notes what was painted, the time by stage, and the report's path. */
void fl_summary_of_render(const FlPlan *plan, const FlStats *stats);

/** Notes that all outputs are complete and up to date: plan->finished. */
void fl_summary_of_nothing(const FlPlan *plan);

/** Notes how much paint was taken from the cache, and why the rest was not. */
void fl_summary_of_reuse(const FlPainters *painters, const FlCaller *caller);

/** Notes what would be painted, and an estimate of the time at frame_s seconds a frame. */
void fl_summary_of_dry_run(const FlPlan *plan, double frame_s);

#endif
