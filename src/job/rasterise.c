#include "job/plan.h"

#include "base/error.h"
#include "cover/cover_map.h"
#include <stdatomic.h>

/* Notes the edges that regions of a frame share. */
static bool note_edges(FlPlan *plan, FlNeighbours *neighbours, int frame, GError **error)
{
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(plan->drawing, frame, error);
    if (draws)
        fl_neighbours_note(neighbours, draws, plan->edge_limits);
    return draws;
}

/* Shapes that are held longer than others are shown below those of later frames. */
static bool all_hold_alike(const FlPlan *plan)
{
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++)
        if (plan->hold_of[r] != plan->hold)
            return false;
    return true;
}

bool fl_plan_hides(const FlPlan *plan, int region)
{
    return plan->seen && !plan->seen[region];
}

static void begin_visible_regions(FlPlan *plan)
{
    const int n = fl_drawing_regions(plan->drawing);
    g_clear_pointer(&plan->seen, g_free);
    if (!fl_plan_frames_alone(plan) || !all_hold_alike(plan))
        return;
    plan->seen = g_new(bool, MAX(n, 1));
    for (int r = 0; r < n; r++)
        plan->seen[r] = plan->painted_of[r] < 0;
}

/* True if some of every region has been seen, or if this is not asked for. */
static bool all_seen(const FlPlan *plan)
{
    for (int p = 0; p < plan->n_painted && plan->seen; p++)
        if (!__atomic_load_n(&plan->seen[plan->painted[p].region], __ATOMIC_RELAXED))
            return false;
    return true;
}

/* Every style's rim, and a pixel where drafts are enlarged. */
static bool note_visible_regions(const FlPlan *plan, const FlDrawList *draws, GError **error)
{
    if (all_seen(plan))
        return true;
    const int n_regions = fl_drawing_regions(plan->drawing);
    g_autofree bool *sheer = g_new(bool, MAX(n_regions, 1));
    FlHiding hiding = {.sheer = sheer, .rim_px = 1};
    for (int r = 0; r < n_regions; r++)
        sheer[r] = plan->edge_limits[r] != FL_EDGE_ADJACENT;
    for (int p = 0; p < plan->n_painted; p++)
        hiding.rim_px = MAX(hiding.rim_px, (int)(plan->painted[p].style->border_px + 0.5f) + 1);
    return fl_cover_note_seen(draws, fl_drawing_width(plan->drawing),
                              fl_drawing_height(plan->drawing), hiding, plan->seen, error);
}

/* Looks what a frame shows, unless something of every region was seen before. */
static bool look(FlPlan *plan, FlNeighbours *neighbours, int frame, GError **error)
{
    if (all_seen(plan))
        return true;
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(plan->drawing, frame, error);
    return draws && note_visible_regions(plan, draws, error);
}

/* Stores the masks of all painted regions in a frame, and what is around them. */
static bool store_masks(FlPlan *plan, FlNeighbours *neighbours, int frame, GError **error)
{
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(plan->drawing, frame, error);
    return draws && note_visible_regions(plan, draws, error) &&
           fl_surround_put(plan->surround, frame, draws, plan->edge_limits, plan->painted_of,
                           plan->ground, neighbours, error);
}

/* A pass over all frames. */
typedef struct Pass {
    FlPlan *plan;
    FlNeighbours *neighbours;
    bool (*work)(FlPlan *, FlNeighbours *, int, GError **);
    double before, share; // of this stage: done in earlier passes, and this one's
    atomic_int done;      // frames
    GThread *caller;      // the thread that tells the progress
} Pass;

static bool tell_masks(Pass *pass, int frame, GError **error)
{
    const FlPlan *plan = pass->plan;
    const FlRenderOptions *o = &plan->options;
    const int frames = fl_drawing_frames(plan->drawing);
    const int done = atomic_fetch_add(&pass->done, 1) + 1;
    if (!o->progress || g_thread_self() != pass->caller)
        return true;
    const FlProgress progress = {.stage = "masks",
                                 .region_index = -1,
                                 .n_regions = plan->n_painted,
                                 .frame = fl_drawing_number(plan->drawing, frame),
                                 .done = (int)(pass->before * frames + pass->share * done),
                                 .total = frames,
                                 .elapsed_s = (double)(g_get_monotonic_time() - plan->start) * 1e-6,
                                 .remaining_s = -1};
    if (o->progress(&progress, o->data))
        return true;
    return fl_fail(error, FL_ERROR_INTERRUPTED, "interrupted before the first frame");
}

static bool each_frame(Pass *pass, GError **error)
{
    const int n = fl_drawing_frames(pass->plan->drawing);
    GError *first = NULL;
    int failed = 0;
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : failed)
    for (int f = 0; f < n; f++) {
        GError *failure = NULL;
        if (failed == 0 && !(pass->work(pass->plan, pass->neighbours, f, &failure) &&
                             tell_masks(pass, f, &failure)))
            failed++;
        fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

bool fl_plan_rasterise(FlPlan *plan, GError **error)
{
    g_autoptr(FlNeighbours) neighbours = fl_neighbours_new(fl_drawing_regions(plan->drawing));
    const bool alone = fl_drawing_regions(plan->drawing) < 2;
    begin_visible_regions(plan);
    const double share = alone ? 1 : .5;
    Pass note = {plan, neighbours, note_edges, 0, share, 0, g_thread_self()};
    Pass store = {plan, neighbours, store_masks, 1 - share, share, 0, g_thread_self()};
    plan->rasterised = (alone || each_frame(&note, error)) && each_frame(&store, error);
    return plan->rasterised;
}

bool fl_plan_find_hidden(FlPlan *plan, GError **error)
{
    Pass pass = {plan, NULL, look, 0, 1, 0, g_thread_self()};
    begin_visible_regions(plan);
    return !plan->seen || each_frame(&pass, error);
}
