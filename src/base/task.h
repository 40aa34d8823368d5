/* One piece of work that goes on beside others, in a thread of its own. */
#ifndef FLUIDY_BASE_TASK_H
#define FLUIDY_BASE_TASK_H

#include <glib.h>
#include <stdbool.h>

typedef bool (*FlWork)(void *data, GError **error);

/** All 0: nothing is under way. */
typedef struct FlTask {
    FlWork work;
    void *data;
    GThread *thread;
    bool failed;
    GError *error; // of work that failed and was not waited for yet
} FlTask;

/**
 * Begins work(data), or does it at once unless `beside`. Nothing of the task may be under way; data
 * must stay, and is the work's alone, until fl_task_wait().
 */
void fl_task_start(FlTask *task, FlWork work, void *data, bool beside);

/** Waits for it. Returns: whether it went well, also if there was nothing; else with its error. */
bool fl_task_wait(FlTask *task, GError **error);

/** Waits for it and forgets its error. */
void fl_task_clear(FlTask *task);

#endif
