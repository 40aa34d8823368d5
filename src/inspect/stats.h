/* Figures of a render as JSON lines: how quality and speed are argued. */
#ifndef FLUIDY_INSPECT_STATS_H
#define FLUIDY_INSPECT_STATS_H

#include "io/atomic_file.h"
#include "job/plan.h"

/** Seconds by stage, and the file of --stats, which appears under its name when it is whole. */
typedef struct FlStats {
    FlAtomicFile file;
    bool open;
    double read_s, guides_s, paint_s, compose_s, write_s;
} FlStats;

/** Begins the file if the plan wants one. */
bool fl_stats_init(FlStats *stats, const FlPlan *plan, GError **error);

/** A line for each region and level that was painted in the frame, then one for the frame. */
void fl_stats_frame(FlStats *stats, const FlPlan *plan, int frame, double paint_s, double compose_s,
                    double write_s);

/** One line about the whole render: seconds of each stage, memory. To be freed. */
char *fl_stats_summary(const FlStats *stats, int n_frames);

/** The most memory that the program has had so far, MiB. */
double fl_peak_mib(void);

bool fl_stats_finish(FlStats *stats, GError **error);
void fl_stats_clear(FlStats *stats);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlStats, fl_stats_clear)

#endif
