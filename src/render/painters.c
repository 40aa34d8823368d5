#include "render/painters.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/schedule.h"
#include "guides/flow_file.h"
#include "inspect/report.h"
#include "io/pattern.h"
#include <math.h>

/* The memory of a render follows from the sizes, so a shortage is known before anything is made. */
static bool check_memory(const FlPainters *painters, GError **error)
{
    const FlPlan *plan = painters->plan;
    double bytes = fl_plan_least_bytes(plan), largest = 0;
    for (int p = 0; p < painters->n; p++) {
        const FlPainter *painter = painters->painter[p];
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
    return !painters->fresh[p] || fl_painter_prepare(painters->painter[p], error);
}

/* While it is painted, a region takes 80 bytes a pixel of its rectangle, and about as many while
 * its guides are made: side by side, regions of more pixels would take as many hundreds of
 * megabytes as there are threads. */
#define BESIDE_PX ((size_t)2 << 20)

static FlWorkItem item_of(const FlPainters *painters, int p, double cost)
{
    const size_t pixels = fl_rect_pixels(painters->painter[p]->result.rect);
    return (FlWorkItem){p, cost, .alone = pixels > BESIDE_PX};
}

static bool make_guides(FlPainters *painters, GError **error)
{
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(painters->n, 1));
    for (int p = 0; p < painters->n; p++)
        items[p] = item_of(painters, p, (double)fl_rect_pixels(painters->painter[p]->result.rect));
    return fl_schedule_run(items, painters->n, make_guides_of, painters, error);
}

/* ---- input from the film --------------------------------------------------------------------- */

/* Flow files have the size of the output, which drafts halve. */
static bool load_flow(const FlPlan *plan, const FlShapes *shapes, const char *file, float unknown,
                      float *flow, GError **error)
{
    const int width = plan->width, height = plan->height;
    if (width == shapes->width && height == shapes->height)
        return fl_flow_load(file, width, height, unknown, flow, error);
    g_autofree float *full =
        fl_alloc(2 * (size_t)width * (size_t)height, sizeof *full, "a flow field", error);
    if (!full || !fl_flow_load(file, width, height, unknown, full, error))
        return false;
    fl_flow_halve(full, width, height, flow);
    return true;
}

/* FlShapes.flow of the painters in data. The first frame may lack a file, since no frame comes
 * before it. */
static bool flow_from_file(void *data, const FlRegionPlan *region, int frame, float unknown,
                           float *flow, GError **error)
{
    const FlPainters *painters = data;
    const FlPlan *plan = painters->plan;
    const FlShapes *shapes = &painters->shapes;
    g_autofree char *file = fl_output_name(
        region->flow_files, fl_drawing_number(plan->drawing, frame), region->name, error);
    if (!file)
        return false;
    if (frame > 0 || region->loops || g_file_test(file, G_FILE_TEST_EXISTS))
        return load_flow(plan, shapes, file, unknown, flow, error);
    for (size_t k = 0; k < 2 * (size_t)shapes->width * (size_t)shapes->height; k++)
        flow[k] = unknown;
    return true;
}

static FlShapes shapes_of(FlPainters *painters)
{
    const FlPlan *plan = painters->plan;
    return (FlShapes){.n_frames = fl_drawing_frames(plan->drawing),
                      .width = fl_drawing_width(plan->drawing),
                      .height = fl_drawing_height(plan->drawing),
                      .seed = plan->options.seed,
                      .masks = plan->masks,
                      .surround = plan->surround,
                      .drawing = plan->drawing,
                      .flow = plan->options.flow ? flow_from_file : NULL,
                      .data = painters,
                      .stop = {plan->any_order ? plan->options.stopped : NULL, plan->options.data}};
}

/* Opens the drawing's own motion for the regions whose paint it carries. */
static bool open_motion(FlPainters *painters, GError **error)
{
    const FlPlan *plan = painters->plan;
    for (int p = 0; p < painters->n; p++) {
        FlPainter *painter = painters->painter[p];
        const bool halved = fl_field_px(painter->plan->style->exemplar) == 2;
        FlMotionSource **motion = &painters->motion[halved];
        if (painter->plan->settings.motion != FL_MOTION_AUTO || painters->shapes.flow ||
            painter->origin != FL_FROM_ENGINE)
            continue;
        if (!*motion &&
            !(*motion = fl_motion_source_new(plan->drawing, plan->masks, halved, error)))
            return false;
        painter->motion = *motion;
    }
    return true;
}

/* ---- the whole ------------------------------------------------------------------------------- */

/* Returns: true if a painter paints a region by this method already. */
static bool paints_so(const FlPainter *painter, const FlRegionPlan *region, FlDigest method)
{
    const FlRegionPlan *before = painter->plan;
    return before && before->style == region->style && before->tile == region->tile &&
           fl_digest_is_known(method) && fl_digest_is_same(painter->reuse.method, method);
}

static void free_painter(FlPainters *painters, FlPainter *painter)
{
    painters->n_painted += painter->reuse.n_painted;
    fl_painter_clear(painter);
    g_free(painter);
}

/* Returns: true if earlier painters are those of a plan's regions, in order. */
static bool same_regions(FlPainters before, const FlPlan *plan)
{
    bool same = before.n == plan->n_painted;
    for (int p = 0; p < before.n && same; p++)
        same = before.painter[p]->plan->region == plan->painted[p].region;
    return same;
}

/* A painter for each region: that of an earlier plan with the same masks, or an empty one. */
static void take_painters(FlPainters *painters, const FlPlan *plan)
{
    const FlPainters before = *painters;
    const bool same =
        before.plan && before.shapes.masks == plan->masks && same_regions(before, plan);
    *painters = (FlPainters){.plan = plan, .n = plan->n_painted, .n_painted = before.n_painted};
    painters->painter = g_new0(FlPainter *, MAX(plan->n_painted, 1));
    painters->painted = g_new0(const FlPaintedRegion *, MAX(plan->n_painted, 1));
    painters->fresh = g_new0(bool, MAX(plan->n_painted, 1));
    painters->shapes = shapes_of(painters);
    for (int p = 0; p < before.n; p++)
        if (same)
            painters->painter[p] = before.painter[p];
        else
            free_painter(painters, before.painter[p]);
    for (int k = 0; k < 2; k++)
        if (same)
            painters->motion[k] = before.motion[k];
        else
            fl_motion_source_free(before.motion[k]);
    g_free(before.painter);
    g_free(before.painted);
    g_free(before.fresh);
    for (int p = 0; p < plan->n_painted; p++) {
        painters->painter[p] = painters->painter[p] ? painters->painter[p] : g_new0(FlPainter, 1);
        painters->painted[p] = &painters->painter[p]->result;
    }
}

void fl_painters_recall(FlPainters *painters, const FlPlan *plan)
{
    take_painters(painters, plan);
    for (int p = 0; p < plan->n_painted; p++) {
        FlPainter *painter = painters->painter[p];
        const FlRegionPlan *region = &plan->painted[p];
        FlReuse reuse = {0};
        fl_reuse_init(&reuse, plan->cache, &painters->shapes, region, plan->inputs);
        painters->fresh[p] = !paints_so(painter, region, reuse.method);
        if (painters->fresh[p]) {
            fl_reuse_recall(&reuse, plan, p);
            painters->n_painted += painter->reuse.n_painted;
            fl_painter_init(painter, &painters->shapes, region, reuse);
        } else {
            fl_painter_follow(painter, region);
            fl_reuse_clear(&reuse);
        }
    }
}

bool fl_painters_need_masks(const FlPainters *painters)
{
    const FlPlan *plan = painters->plan;
    bool needed = false;
    if (plan->rasterised)
        return false;
    for (int p = 0; p < painters->n && !needed; p++) {
        const FlRegionPlan *region = &plan->painted[p];
        const bool placed =
            region->paint_files && (region->place.width > 0 || fl_plan_hides(plan, region->region));
        needed = !placed && !painters->painter[p]->reuse.known;
    }
    return needed;
}

bool fl_painters_stale(const FlPainters *painters)
{
    bool stale = false;
    for (int p = 0; p < painters->n; p++)
        stale = stale || painters->painter[p]->reuse.stale;
    return stale;
}

int fl_painters_painted(const FlPainters *painters)
{
    int n = painters->n_painted;
    for (int p = 0; p < painters->n; p++)
        n += painters->painter[p]->reuse.n_painted;
    return n;
}

void fl_painters_finish(FlPainters *painters)
{
    for (int p = 0; p < painters->n; p++)
        fl_reuse_finish(&painters->painter[p]->reuse);
}

bool fl_painters_init(FlPainters *painters, GError **error)
{
    const FlPlan *plan = painters->plan;
    const bool energies = plan->options.stats || plan->options.report;
    for (int p = 0; p < painters->n; p++)
        if (painters->fresh[p])
            fl_painter_place(painters->painter[p], fl_plan_hides(plan, plan->painted[p].region));
    if (!check_memory(painters, error) || !open_motion(painters, error) ||
        !make_guides(painters, error))
        return false;
    for (int p = 0; p < painters->n; p++)
        if (painters->painter[p]->paint && plan->painted[p].engine->measure)
            plan->painted[p].engine->measure(painters->painter[p]->paint, energies);
    return true;
}

void fl_painters_forget(FlPainters *painters)
{
    for (int p = 0; p < painters->n; p++)
        if (painters->fresh[p])
            painters->painter[p]->reuse.method = (FlDigest){0};
}

void fl_painters_clear(FlPainters *painters)
{
    for (int p = 0; p < painters->n; p++)
        free_painter(painters, painters->painter[p]);
    fl_motion_source_free(painters->motion[0]);
    fl_motion_source_free(painters->motion[1]);
    g_free(painters->painter);
    g_free(painters->painted);
    g_free(painters->fresh);
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
    return step->work(step->data, p, step->step, error);
}

/* The cost of a picture, seconds of one thread: that of the last picture, or the usual one for the
 * area. */
static double cost_of(const FlPainter *painter)
{
    return painter->cost_s > 0 ? painter->cost_s : 3e-6 * painter->plan->area_px;
}

/* A region at rest costs no time, but it does when it moves again; and a held frame shows the
 * picture of an earlier step. */
static void note_cost(FlPainter *painter, int step, bool together)
{
    if (step % painter->plan->settings.hold == 0 && painter->result.stats.n_levels > 0)
        painter->cost_s = painter->result.seconds * (together ? fl_schedule_threads() : 1);
}

bool fl_painters_each(FlPainters *painters, int step, FlPainterWork work, void *data,
                      GError **error)
{
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(painters->n, 1));
    for (int p = 0; p < painters->n; p++)
        items[p] = item_of(painters, p, cost_of(painters->painter[p]));
    Step all = {step, work, data};
    if (!fl_schedule_run(items, painters->n, do_one, &all, error))
        return false;
    for (int k = 0; k < painters->n; k++)
        note_cost(painters->painter[items[k].index], step, items[k].together);
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
        if (!fl_painter_save(painters->painter[p], parts, &failure))
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
        if (!fl_painter_load(painters->painter[p], parts + FL_PAINTER_PARTS * p, error))
            return false;
    return true;
}
