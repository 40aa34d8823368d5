/* One piece of work in a thread of its own. */
#ifndef FLUIDY_BASE_TASK_H
#define FLUIDY_BASE_TASK_H

#include <glib.h>
#include <stdbool.h>

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

#endif
