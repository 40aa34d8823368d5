#include "base/schedule.h"

#include "base/parallel_error.h"
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

bool fl_schedule_is_large(double share, double total)
{
    return share * fl_schedule_threads() > total;
}

/* Large ones first, then by cost; equal ones in the order of their indices. */
static int by_turn(const void *a, const void *b)
{
    const FlWorkItem *p = a, *q = b;
    if (p->large != q->large)
        return q->large - p->large;
    if (p->cost != q->cost)
        return (p->cost < q->cost) - (p->cost > q->cost);
    return (p->index > q->index) - (p->index < q->index);
}

bool fl_schedule_run(FlWorkItem *items, int n, FlItemWork work, void *data, GError **error)
{
    int first_small = 0;
    qsort(items, (size_t)n, sizeof *items, by_turn);
    for (; first_small < n && items[first_small].large; first_small++)
        if (!work(data, items[first_small].index, 0, error))
            return false;
    if (first_small == n)
        return true;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = first_small; k < n; k++) {
        GError *failure = NULL;
        if (!work(data, items[k].index, team_member(), &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_tell(error, first);
}
