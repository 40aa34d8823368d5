/* What a render says when it is done. */
#ifndef FLUIDY_RENDER_SUMMARY_H
#define FLUIDY_RENDER_SUMMARY_H

#include "inspect/stats.h"
#include "job/plan.h"

/** Tells options->note what was painted, how long it took and where the report is. */
void fl_summary_of_render(const FlPlan *plan, const FlStats *stats);

/** Tells options->note what would be painted, and how long that would take at frame_s a frame. */
void fl_summary_of_rehearsal(const FlPlan *plan, double frame_s);

#endif
