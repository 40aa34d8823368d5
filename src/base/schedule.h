/* The schedule of parallel work: every rule about threads is here. One piece of work in a thread of
 * its own. */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>

/** The number of threads of a team, >= 1; 1 without OpenMP. */
int fl_schedule_threads(void);

/** The same, but no more than `most`: for threads that take much memory each. */
int fl_schedule_threads_up_to(int most);

/** The same, but no more than a search over so many pixels has work for. */
int fl_schedule_threads_for(size_t pixels);

/** Sets that number for the calling thread. Returns: the number before. */
int fl_schedule_set_threads(int n);

/** The size of the team that runs the innermost parallel region around the caller, >= 1. */
int fl_schedule_team_size(void);

/** Returns: true if a loop over so many pixels is worth a team of threads: fewer are done before a
 * team wakes up. */
static inline bool fl_schedule_worth_threads(size_t pixels)
{
    return pixels > (size_t)1 << 15;
}

/**
 * Returns: true if one area of that many pixels per thread fits into a frame. Such areas are
 * processed side by side, a thread each, and larger ones by all threads together, so that scratch
 * never takes more than that of a whole frame.
 */
bool fl_schedule_fits_beside(size_t pixels, size_t frame_pixels);

/** One of several pieces of work. */
typedef struct FlWorkItem {
    int index;     // passed to the work function
    double cost;   // of one thread, in any unit that all items share
    bool alone;    // is too large to be done beside others
    bool together; // result: all threads worked on this item
} FlWorkItem;

/** thread: 0 … fl_schedule_threads() - 1, no two at a time the same. */
typedef bool (*FlItemWork)(void *data, int index, int thread, GError **error);

/**
 * Does all items: those that are alone and the most expensive of the others in turn with all
 * threads, outside any team, since inside one, even of one thread, a search would start and end its
 * own threads at every step; then the rest side by side, a thread each, the most expensive first,
 * so that no expensive item is left for the end.
 *
 * Reorders the items. Returns: false with the first error; after a failed item of all threads no
 * further item starts.
 */
bool fl_schedule_run(FlWorkItem *items, int n, FlItemWork work, void *data, GError **error);

/* ---- one piece of work beside others --------------------------------------------------------- */

typedef bool (*FlWork)(void *data, GError **error);

/** All 0: no work is running. */
typedef struct FlTask {
    FlWork work;
    void *data;
    GThread *thread;
    bool failed;
    int threads;   // of its team: as many as its starter has
    GError *error; // of work that failed, until fl_task_wait()
} FlTask;

/**
 * Starts work(data) in a thread, or does it at once unless `beside`. The task must be idle; data
 * belongs to the work until fl_task_wait().
 */
void fl_task_start(FlTask *task, FlWork work, void *data, bool beside);

/** Waits for the work. Returns: true if it succeeded or no work was started; else false with its
 * error. */
bool fl_task_wait(FlTask *task, GError **error);

/** Waits for the work and drops its error. */
void fl_task_clear(FlTask *task);
