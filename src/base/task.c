#include "base/task.h"

#include "base/schedule.h"

static void *run(void *data)
{
    FlTask *task = data;
    (void)fl_schedule_set_threads(task->threads); // a new thread would take all processors
    task->failed = !task->work(task->data, &task->error);
    return NULL;
}

void fl_task_start(FlTask *task, FlWork work, void *data, bool beside)
{
    g_assert(!task->thread && !task->failed);
    *task = (FlTask){.work = work, .data = data, .threads = fl_schedule_threads()};
    task->thread = beside ? g_thread_try_new("beside", run, task, NULL) : NULL;
    if (!task->thread)
        run(task);
}

bool fl_task_wait(FlTask *task, GError **error)
{
    if (task->thread)
        g_thread_join(task->thread);
    const bool good = !task->failed;
    if (!good)
        g_propagate_error(error, task->error);
    *task = (FlTask){0};
    return good;
}

void fl_task_clear(FlTask *task)
{
    g_autoptr(GError) error = NULL;
    fl_task_wait(task, &error);
}
