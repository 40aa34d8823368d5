/* The schedule of parallel work: every rule about threads is here. */
#ifndef FLUIDY_BASE_SCHEDULE_H
#define FLUIDY_BASE_SCHEDULE_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>

/** The number of threads of a team, >= 1; 1 without OpenMP. */
int fl_schedule_threads(void);

/** Sets that number for the calling thread. Returns: the number before. */
int fl_schedule_set_threads(int n);

/** The size of the team that runs the innermost parallel region around the caller, >= 1. */
int fl_schedule_team_size(void);

/** Whether a loop over so many pixels is worth a team: fewer are done before a team wakes up. */
static inline bool fl_schedule_worth_threads(size_t pixels)
{
    return pixels > (size_t)1 << 15;
}

/**
 * Whether one area of that many pixels per thread fits into a frame. Such areas are processed side
 * by side, a thread each, and larger ones by all threads together, so that scratch never takes
 * more than that of a whole frame.
 */
bool fl_schedule_fits_beside(size_t pixels, size_t frame_pixels);

/** Whether an item is larger than a thread's share of the total: all threads do it together. */
bool fl_schedule_is_large(double share, double total);

/** One of several pieces of work. */
typedef struct FlWorkItem {
    int index;   // passed to the work function
    double cost; // in any unit: the most expensive ones begin first
    bool large;  // uses all threads itself
} FlWorkItem;

/** thread: 0 … fl_schedule_threads() - 1, no two at a time the same. */
typedef bool (*FlItemWork)(void *data, int index, int thread, GError **error);

/**
 * Does all items: large ones in turn with all threads, outside any team, since inside one, even of
 * one thread, a search would start and end its own threads at every step; then the others side by
 * side, a thread each, the most expensive first, so that none is left for the end.
 *
 * Reorders the items. Returns: false with the first error; nothing follows a large item that fails.
 */
bool fl_schedule_run(FlWorkItem *items, int n, FlItemWork work, void *data, GError **error);

#endif
