#include "render/painters.h"

#include "base/limits.h"
#include "base/parallel_error.h"
#include "base/schedule.h"
#include "inspect/report.h"
#include "render/painter_guides.h"
#include <math.h>

/* The memory of a render follows from the sizes, so a shortage is known before anything is made. */
static bool check_memory(const FlPainters *painters, GError **error)
{
    const FlPlan *plan = painters->plan;
    const double pixels = (double)plan->width * plan->height;
    double bytes = 50e6 + 30 * pixels, largest = 0; // measured: the libraries, paper, a frame
    for (int p = 0; p < painters->n; p++) {
        const FlPainter *painter = &painters->painter[p];
        bytes += fl_painter_bytes(painter, fl_plan_is_large(plan));
        largest = MAX(largest, (double)fl_rect_pixels(painter->result.rect));
    }
    bytes += 90 * largest; // measured: what is painted at a time, and scratch
    bytes += fl_style_cache_bytes(plan->styles);
    g_autofree char *where =
        g_strdup_printf("%s, %d regions in %dx%d pixels", fl_drawing_name(plan->drawing),
                        painters->n, plan->width, plan->height);
    return fl_limit_check(FL_LIMIT_MEMORY, ceil(bytes / (1 << 20)), where, error);
}

static bool make_guides_of(void *data, int p, int thread, GError **error)
{
    FlPainters *painters = data;
    return fl_painter_prepare(&painters->painter[p], painters->plan->options.seed, error);
}

/* While it is painted, a region takes 80 bytes a pixel of its rectangle, and about as many while
 * its guides are made: side by side, regions of more pixels would take as many hundreds of
 * megabytes as there are threads. */
#define BESIDE_PX ((size_t)2 << 20)

static FlWorkItem item_of(const FlPainters *painters, int p, double cost)
{
    const size_t pixels = fl_rect_pixels(painters->painter[p].result.rect);
    return (FlWorkItem){p, cost, .alone = pixels > BESIDE_PX};
}

#define FIRST_BYTES ((size_t)32 << 20) // of distances that wait to be asked for by first pictures

/* The first picture of most regions is painted soon after its guides are made. */
static void choose_kept(FlPainters *painters)
{
    size_t bytes = 0;
    for (int p = 0; p < painters->n; p++) {
        FlPainter *painter = &painters->painter[p];
        const size_t own = fl_rect_pixels(fl_painter_guided(painter)) * sizeof(float);
        painter->keeps_first = bytes + own <= FIRST_BYTES;
        bytes += painter->keeps_first ? own : 0;
    }
}

static bool make_guides(FlPainters *painters, GError **error)
{
    choose_kept(painters);
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(painters->n, 1));
    for (int p = 0; p < painters->n; p++)
        items[p] = item_of(painters, p, (double)fl_rect_pixels(painters->painter[p].result.rect));
    return fl_schedule_run(items, painters->n, make_guides_of, painters, error);
}

/* Whether a region is carried along the drawing's own motion. */
static bool wants_motion(const FlRegionPlan *region)
{
    return region->settings.motion == FL_MOTION_AUTO && !region->flow_files && !region->paint_files;
}

static bool open_motion(FlPainters *painters, GError **error)
{
    const FlPlan *plan = painters->plan;
    for (int p = 0; p < plan->n_painted; p++) {
        const bool halved = plan->painted[p].style->enlargement;
        if (!wants_motion(&plan->painted[p]) || (painters->reuse && painters->reuse[p].known))
            continue;
        FlMotionSource **motion = &painters->motion[halved];
        if (!*motion &&
            !(*motion = fl_motion_source_new(plan->drawing, plan->masks, halved, error)))
            return false;
        painters->painter[p].motion = *motion;
    }
    return true;
}

bool fl_painters_recall(FlPainters *painters, const FlPlan *plan, FlPaintCache *cache,
                        const FlFingerprint *whole, GError **error)
{
    g_autoptr(GHashTable) styles = fl_style_sums_new();
    painters->n = plan->n_painted;
    painters->reuse = g_new0(FlReuse, MAX(plan->n_painted, 1));
    for (int p = 0; p < plan->n_painted; p++)
        if (!fl_reuse_init(&painters->reuse[p], cache, plan, p, styles, whole, error))
            return false;
    return true;
}

bool fl_painters_need_masks(const FlPainters *painters, const FlPlan *plan)
{
    bool needed = false;
    for (int p = 0; p < plan->n_painted && !needed; p++)
        needed = painters->reuse ? !painters->reuse[p].known
                                 : plan->painted[p].place.width == 0 &&
                                       !fl_plan_hides(plan, plan->painted[p].region);
    return needed;
}

bool fl_painters_stale(const FlPainters *painters)
{
    bool stale = false;
    for (int p = 0; painters->reuse && p < painters->n; p++)
        stale = stale || painters->reuse[p].stale;
    return stale;
}

void fl_painters_finish(FlPainters *painters)
{
    for (int p = 0; painters->reuse && p < painters->n; p++)
        fl_reuse_finish(&painters->reuse[p]);
}

bool fl_painters_init(FlPainters *painters, const FlPlan *plan, GError **error)
{
    painters->plan = plan, painters->n = plan->n_painted;
    painters->painter = g_new0(FlPainter, MAX(painters->n, 1));
    for (int p = 0; p < painters->n; p++)
        fl_painter_init(&painters->painter[p], plan, &plan->painted[p],
                        painters->reuse ? &painters->reuse[p] : NULL);
    if (!check_memory(painters, error) || !open_motion(painters, error) ||
        !make_guides(painters, error))
        return false;
    for (int p = 0; p < painters->n; p++)
        if (painters->painter[p].paint && plan->painted[p].engine->measure)
            plan->painted[p].engine->measure(painters->painter[p].paint,
                                             plan->options.stats ||
                                                 fl_report_measures(&plan->options));
    return true;
}

void fl_painters_clear(FlPainters *painters)
{
    for (int p = 0; painters->painter && p < painters->n; p++)
        fl_painter_clear(&painters->painter[p]);
    for (int p = 0; painters->reuse && p < painters->n; p++)
        fl_reuse_clear(&painters->reuse[p]);
    fl_motion_source_free(painters->motion[0]);
    fl_motion_source_free(painters->motion[1]);
    g_free(painters->painter);
    g_free(painters->reuse);
    *painters = (FlPainters){0};
}

/* A step of all painters. */
typedef struct Step {
    int step;
    FlPainterWork work;
    void *data;
} Step;

static bool do_one(void *data, int p, int thread, GError **error)
{
    const Step *step = data;
    g_auto(FlGuides) guides = {0};
    return step->work(step->data, p, step->step, &guides, error);
}

/* How long a thread takes, in seconds: what it took the last time, or what is usual for the area.
 */
static double cost_of(const FlPainter *painter)
{
    return painter->cost_s > 0 ? painter->cost_s : 3e-6 * painter->plan->area_px;
}

/* A region that rests costs nothing, but it does when it moves again; and a held frame shows the
 * picture of an earlier step. */
static void note_cost(FlPainter *painter, int step, bool together)
{
    if (step % painter->plan->settings.hold == 0 && painter->result.stats.n_levels > 0)
        painter->cost_s = painter->result.seconds * (together ? fl_schedule_gain() : 1);
}

bool fl_painters_each(FlPainters *painters, int step, FlPainterWork work, void *data,
                      GError **error)
{
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(painters->n, 1));
    for (int p = 0; p < painters->n; p++)
        items[p] = item_of(painters, p, cost_of(&painters->painter[p]));
    Step all = {step, work, data};
    if (!fl_schedule_run(items, painters->n, do_one, &all, error))
        return false;
    for (int k = 0; k < painters->n; k++)
        note_cost(&painters->painter[items[k].index], step, items[k].together);
    return true;
}

bool fl_painters_save(const FlPainters *painters, GPtrArray *states, GError **error)
{
    GError *first = NULL;
    g_ptr_array_set_size(states, 0);
    g_ptr_array_set_size(states, FL_PAINTER_PARTS * painters->n);
#pragma omp parallel for schedule(dynamic, 1)
    for (int p = 0; p < painters->n; p++) {
        GError *failure = NULL;
        GBytes **parts = (GBytes **)states->pdata + FL_PAINTER_PARTS * p;
        if (!fl_painter_save(&painters->painter[p], parts, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

bool fl_painters_load(FlPainters *painters, const GPtrArray *states, const char *path,
                      GError **error)
{
    GBytes *const *parts = (GBytes *const *)states->pdata;
    if (states->len != (guint)(FL_PAINTER_PARTS * painters->n)) {
        g_set_error(error, FL_ERROR, FL_ERROR_CHANGED,
                    "%s: has the state of another number of regions; use ‘overwrite’ to start anew",
                    path);
        return false;
    }
    for (int p = 0; p < painters->n; p++)
        if (!fl_painter_load(&painters->painter[p], parts + FL_PAINTER_PARTS * p, error))
            return false;
    return true;
}
