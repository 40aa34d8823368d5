#include "base/schedule.h"

#include "base/error.h"
#include <stdlib.h>
#ifdef _OPENMP
#include <omp.h>
#endif

int fl_schedule_threads(void)
{
#ifdef _OPENMP
    return MAX(omp_get_max_threads(), 1);
#else
    return 1;
#endif
}

int fl_schedule_threads_up_to(int most)
{
    return MIN(fl_schedule_threads(), most);
}

int fl_schedule_threads_for(size_t pixels)
{
    const size_t each = 1024; // a search takes 4 tiles of 16 px at a time, of a 16th of all
    return (int)MIN((size_t)fl_schedule_threads(), pixels / each + 1);
}

int fl_schedule_set_threads(int n)
{
    const int before = fl_schedule_threads();
#ifdef _OPENMP
    omp_set_num_threads(n);
#endif
    return before;
}

int fl_schedule_team_size(void)
{
#ifdef _OPENMP
    return omp_get_num_threads();
#else
    return 1;
#endif
}

static int team_member(void)
{
#ifdef _OPENMP
    return omp_get_thread_num();
#else
    return 0;
#endif
}

bool fl_schedule_fits_beside(size_t pixels, size_t frame_pixels)
{
    return pixels * (size_t)fl_schedule_threads() <= frame_pixels;
}

/* Those that are alone first, then by cost; equal ones in the order of their indices. */
static int by_turn(const void *a, const void *b)
{
    const FlWorkItem *p = a, *q = b;
    if (p->alone != q->alone)
        return q->alone - p->alone;
    if (p->cost != q->cost)
        return (p->cost < q->cost) - (p->cost > q->cost);
    return (p->index > q->index) - (p->index < q->index);
}

/* The number of items, from the first in order, that all threads work on together: the fewest that
 * leave none so long that the others would wait for it. Two threads search the regions of a film
 * together 1.9 to 2.1 times as fast as one. */
static int count_together(const FlWorkItem *items, int n)
{
    double beside = 0;
    for (int k = 0; k < n; k++)
        beside += items[k].cost;
    int k = 0;
    while (k < n && (items[k].alone || items[k].cost * fl_schedule_threads() > beside))
        beside -= items[k++].cost;
    return k;
}

bool fl_schedule_run(FlWorkItem *items, int n, FlItemWork work, void *data, GError **error)
{
    qsort(items, (size_t)n, sizeof *items, by_turn);
    const int n_together = count_together(items, n);
    for (int k = 0; k < n; k++)
        items[k].together = k < n_together;
    for (int k = 0; k < n_together; k++)
        if (!work(data, items[k].index, 0, error))
            return false;
    if (n_together == n)
        return true;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = n_together; k < n; k++) {
        GError *failure = NULL;
        if (!work(data, items[k].index, team_member(), &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

/* ---- one piece of work beside others --------------------------------------------------------- */

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
