#include "render/painters.h"

#include "base/alloc.h"
#include "base/limits.h"
#include "base/schedule.h"
#include "guides/flow_file.h"
#include "io/pattern.h"
#include <math.h>

/* The memory of a render follows from the sizes, so a shortage is known before anything is made. */
static bool check_memory(const FlPainters *painters, double bytes, GError **error)
{
    const FlShapes *shapes = &painters->shapes;
    double largest = 0;
    bytes += fl_shapes_least_bytes(shapes);
    for (int p = 0; p < painters->n; p++) {
        const FlPainter *painter = painters->painter[p];
        bytes += fl_painter_bytes(painter);
        largest = MAX(largest, (double)fl_rect_pixels(painter->result.rect));
    }
    bytes += 90 * largest; // measured: what is painted at a time, and scratch
    g_autofree char *where =
        g_strdup_printf("%s, %d regions in %dx%d pixels", fl_drawing_name(shapes->drawing),
                        painters->n, shapes->page_width, shapes->page_height);
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

/* Flow files have the size of the frames, which drafts halve. */
static bool load_flow(const FlShapes *shapes, const char *file, float unknown, float *flow,
                      GError **error)
{
    const int width = shapes->page_width, height = shapes->page_height;
    if (width == shapes->width && height == shapes->height)
        return fl_flow_load(file, width, height, unknown, flow, error);
    g_autofree float *full =
        fl_alloc(2 * (size_t)width * (size_t)height, sizeof *full, "a flow field", error);
    if (!full || !fl_flow_load(file, width, height, unknown, full, error))
        return false;
    fl_flow_halve(full, width, height, flow);
    return true;
}

/* FlShapes.flow of the shapes in data. The first frame may lack a file, since no frame comes before
 * it. */
static bool flow_from_file(void *data, const FlRegionPlan *region, int frame, float unknown,
                           float *flow, GError **error)
{
    const FlShapes *shapes = data;
    g_autofree char *file = fl_output_name(
        region->flow_files, fl_drawing_number(shapes->drawing, frame), region->name, error);
    if (!file)
        return false;
    if (frame > 0 || region->loops || g_file_test(file, G_FILE_TEST_EXISTS))
        return load_flow(shapes, file, unknown, flow, error);
    for (size_t k = 0; k < 2 * (size_t)shapes->width * (size_t)shapes->height; k++)
        flow[k] = unknown;
    return true;
}

/* Copies them, since painters stay while plans follow each other. */
static void take_shapes(FlPainters *painters, const FlShapes *shapes)
{
    painters->shapes = *shapes;
    painters->shapes.flow =
        shapes->n_painted > 0 && shapes->painted[0].flow_files ? flow_from_file : NULL;
    painters->shapes.data = &painters->shapes;
}

/* Opens the drawing's own motion for the regions whose paint it carries. */
static bool open_motion(FlPainters *painters, GError **error)
{
    const FlShapes *shapes = &painters->shapes;
    for (int p = 0; p < painters->n; p++) {
        FlPainter *painter = painters->painter[p];
        const bool halved = fl_field_px(painter->plan->style->exemplar) == 2;
        FlMotionSource **motion = &painters->motion[halved];
        if (painter->plan->settings.motion != FL_MOTION_AUTO || painters->shapes.flow ||
            painter->origin != FL_FROM_ENGINE)
            continue;
        if (!*motion &&
            !(*motion = fl_motion_source_new(shapes->drawing, shapes->masks, halved, error)))
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
    return before && before->style == region->style && fl_digest_is_known(method) &&
           fl_digest_is_same(painter->reuse.method, method);
}

static void free_painter(FlPainters *painters, FlPainter *painter)
{
    painters->n_painted += painter->reuse.n_painted;
    fl_painter_clear(painter);
    g_free(painter);
}

/* Returns: true if earlier painters are those of a plan's regions, in order. */
static bool same_regions(FlPainters before, const FlShapes *shapes)
{
    bool same = before.n == shapes->n_painted;
    for (int p = 0; p < before.n && same; p++)
        same = before.painter[p]->plan->region == shapes->painted[p].region;
    return same;
}

/* A painter for each region: that of an earlier plan with the same masks, or an empty one. */
static void take_painters(FlPainters *painters, const FlShapes *shapes)
{
    const FlPainters before = *painters;
    const bool same = before.shapes.masks == shapes->masks && same_regions(before, shapes);
    *painters = (FlPainters){.n = shapes->n_painted, .n_painted = before.n_painted};
    painters->painter = g_new0(FlPainter *, MAX(shapes->n_painted, 1));
    painters->painted = g_new0(const FlPaintedRegion *, MAX(shapes->n_painted, 1));
    painters->fresh = g_new0(bool, MAX(shapes->n_painted, 1));
    take_shapes(painters, shapes);
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
    for (int p = 0; p < shapes->n_painted; p++) {
        painters->painter[p] = painters->painter[p] ? painters->painter[p] : g_new0(FlPainter, 1);
        painters->painted[p] = &painters->painter[p]->result;
    }
}

void fl_painters_recall(FlPainters *painters, const FlShapes *shapes, const FlKeeping *keeping)
{
    take_painters(painters, shapes);
    for (int p = 0; p < shapes->n_painted; p++) {
        FlPainter *painter = painters->painter[p];
        const FlRegionPlan *region = &shapes->painted[p];
        FlReuse reuse = {0};
        fl_reuse_init(&reuse, keeping->cache, &painters->shapes, region, keeping->inputs);
        painters->fresh[p] = !paints_so(painter, region, reuse.method);
        if (painters->fresh[p]) {
            fl_reuse_recall(&reuse, keeping, shapes, p);
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
    const FlShapes *shapes = &painters->shapes;
    bool needed = false;
    if (shapes->rasterised)
        return false;
    for (int p = 0; p < painters->n && !needed; p++) {
        const FlRegionPlan *region = &shapes->painted[p];
        const bool placed = region->paint_files &&
                            (region->place.width > 0 || fl_shapes_hide(shapes, region->region));
        needed = !placed && !painters->painter[p]->reuse.known;
    }
    return needed;
}

bool fl_painters_flow(const FlPainters *painters)
{
    bool flows = false;
    for (int p = 0; p < painters->n; p++) {
        const FlPainter *painter = painters->painter[p];
        flows =
            flows || (painters->fresh[p] && !painter->reuse.known && !painter->plan->paint_files &&
                      painter->plan->settings.fluid > FL_FLUID_NONE);
    }
    return flows;
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

bool fl_painters_init(FlPainters *painters, const FlShapes *shapes, double bytes, bool energies,
                      GError **error)
{
    take_shapes(painters, shapes);
    for (int p = 0; p < painters->n; p++)
        if (painters->fresh[p])
            fl_painter_place(painters->painter[p],
                             fl_shapes_hide(shapes, shapes->painted[p].region));
    if (!check_memory(painters, bytes, error) || !open_motion(painters, error) ||
        !make_guides(painters, error))
        return false;
    for (int p = 0; p < painters->n; p++)
        if (painters->painter[p]->paint && shapes->painted[p].engine->measure)
            shapes->painted[p].engine->measure(painters->painter[p]->paint, energies);
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
