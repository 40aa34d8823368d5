#include "render/held.h"

#include <string.h>

/** The hold of a region that is painted, else the film's. */
static int hold_of(const FlPlan *plan, int region)
{
    const int p = plan->painter_of[region];
    return p >= 0 ? plan->painters[p].treatment.hold : plan->hold;
}

static void insert(GArray *runs, int at, FlRun *run)
{
    g_array_insert_val(runs, (guint)at, *run);
    *run = (FlRun){.region = run->region}; // its pictures have a new owner
}

/** Index of the last run of a region, -1 if it has none. */
static int last_of(const GArray *runs, int region)
{
    for (int r = (int)runs->len - 1; r >= 0; r--)
        if (g_array_index(runs, FlRun, r).region == region)
            return r;
    return -1;
}

/** Where run k of an earlier frame goes that has no counterpart. */
static int place_of(const GArray *runs, const FlRuns *earlier, int k)
{
    for (int below = k; below >= 0; below--) {
        const int last = last_of(runs, earlier->run[below].region);
        if (last >= 0)
            return last + 1;
    }
    return 0;
}

/** The lowest run of a region that is not taken yet. */
static FlRun *first_left(const FlRuns *runs, int region)
{
    for (int r = 0; r < runs->n; r++)
        if (runs->run[r].region == region && runs->run[r].coverage)
            return &runs->run[r];
    return NULL;
}

/** Whether a region's runs are taken from frame `from` when frame `now` is shown. */
static bool is_from(const FlPlan *plan, int region, int frame, int from, int now)
{
    const int shown = frame - frame % hold_of(plan, region);
    return shown == from && shown != now;
}

/** Puts the runs of the regions that show `from` in the place of what they have in runs. */
static bool replace(const FlPlan *plan, GArray *runs, int frame, int from, int now, GError **error)
{
    g_autoptr(FlRuns) earlier = fl_film_runs(plan->film, from, error);
    if (!earlier)
        return false;
    for (int r = 0; r < (int)runs->len; r++) {
        FlRun *run = &g_array_index(runs, FlRun, r);
        if (!is_from(plan, run->region, frame, from, now))
            continue;
        FlRun *then = first_left(earlier, run->region);
        fl_run_clear(run);
        if (then)
            *run = *then, *then = (FlRun){.region = run->region};
        else
            g_array_remove_index(runs, (guint)r--);
    }
    for (int k = 0; k < earlier->n; k++)
        if (earlier->run[k].coverage && is_from(plan, earlier->run[k].region, frame, from, now))
            insert(runs, place_of(runs, earlier, k), &earlier->run[k]);
    return true;
}

FlRuns *fl_held_runs(const FlPlan *plan, int frame, GError **error)
{
    const int now = frame - frame % plan->hold;
    g_autoptr(FlRuns) shown = fl_film_runs(plan->film, now, error);
    if (!shown)
        return NULL;
    g_autoptr(GHashTable) done = g_hash_table_new(NULL, NULL);
    GArray *runs = g_array_new(FALSE, FALSE, sizeof(FlRun));
    g_array_append_vals(runs, shown->run, (guint)shown->n);
    bool good = true;
    for (int p = 0; p < plan->n_painters && good; p++) {
        const int from = frame - frame % plan->painters[p].treatment.hold;
        if (from != now && g_hash_table_add(done, GINT_TO_POINTER(from)))
            good = replace(plan, runs, frame, from, now, error);
    }
    g_free(shown->run);
    shown->n = (int)runs->len;
    shown->run = (FlRun *)g_array_free(runs, FALSE);
    return good ? g_steal_pointer(&shown) : NULL;
}
