/* Statistics of a render as JSON lines: energies and times. */
#pragma once

#include "compose/painted_region.h"
#include "io/atomic_file.h"

/** Seconds by stage, and the file of --stats, which appears when it is complete. */
typedef struct FlStats {
    FlAtomicFile file;
    bool open;
    double read_s, guides_s, paint_s, compose_s, write_s;
} FlStats;

/** Opens the file; path NULL: there is none. */
bool fl_stats_init(FlStats *stats, const char *path, bool overwrite, GError **error);

/**
 * Writes a line for each of the n regions and each of its levels in a frame, then a line for the
 * frame with its seconds.
 */
void fl_stats_frame(FlStats *stats, const FlPaintedRegion *const *painted, int n, int number,
                    double paint_s, double compose_s, double write_s);

/** One line about the whole render: seconds of each stage, memory. To be freed. */
char *fl_stats_summary(const FlStats *stats, int n_frames);

/** The peak memory of the process so far, MiB. */
double fl_peak_mib(void);

bool fl_stats_finish(FlStats *stats, GError **error);
void fl_stats_clear(FlStats *stats);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlStats, fl_stats_clear)
