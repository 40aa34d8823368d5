/* What runs side by side: every rule about threads is here. */
#ifndef FLUIDY_BASE_SCHEDULE_H
#define FLUIDY_BASE_SCHEDULE_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>

/** How many threads work together, >= 1; 1 without OpenMP. */
int fl_schedule_threads(void);

/** Sets how many there are from now on, in this thread. Returns: how many there were. */
int fl_schedule_set_threads(int n);

/** The size of the team that runs the innermost parallel region around the caller, >= 1. */
int fl_schedule_team_size(void);

/** Whether a loop over so many pixels is worth a team: fewer are done before the others wake up. */
static inline bool fl_schedule_worth_threads(size_t pixels)
{
    return pixels > (size_t)1 << 15;
}

/**
 * Whether as many areas of that many pixels as there are threads fit into a frame. Such areas are
 * worked on side by side, a thread each, and larger ones by all threads together, so that scratch
 * never takes more than a whole frame's would.
 */
bool fl_schedule_fits_beside(size_t pixels, size_t frame_pixels);

/** Whether one share of the work is as large as a thread's: all threads together do it. */
bool fl_schedule_is_large(double share, double total);

/** One of several pieces of work. */
typedef struct FlWorkItem {
    int index;   // that the work is called with
    double cost; // in any unit: the most expensive ones begin first
    bool large;  // uses all threads itself
} FlWorkItem;

/** thread: 0 … fl_schedule_threads() - 1, no two at a time the same. */
typedef bool (*FlItemWork)(void *data, int index, int thread, GError **error);

/**
 * Does all of them: large ones one after the other with all threads, outside any team, since inside
 * one, even of one thread, a search would make and end its own threads for every step; then the
 * others side by side, a thread each, the most expensive first, so that none is waited for.
 *
 * The items are put in another order. Returns: false with the first error of those that fail; what
 * comes after a large one that fails is not done.
 */
bool fl_schedule_run(FlWorkItem *items, int n, FlItemWork work, void *data, GError **error);

#endif
