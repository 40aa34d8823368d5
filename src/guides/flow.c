#include "guides/flow.h"

#include "base/alloc.h"
#include "guides/guides.h"
#include "guides/laplace.h"
#include "guides/part_tracking.h"
#include <math.h>
#include <string.h>

static const float least_gradient = 0.25f; // below it a gradient has no direction

/** The parts of the shape, and where each was and will be. */
typedef struct Traces {
    FlTrace *before, *after; // by part number
    uint32_t *fixed;         // number of pixels of the part that have a velocity
} Traces;

static void traces_clear(Traces *traces)
{
    g_free(traces->before);
    g_free(traces->after);
    g_free(traces->fixed);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Traces, traces_clear)

static bool traces_init(Traces *traces, const FlOutline *now, const FlOutline *before,
                        const FlOutline *after, float limit_px, GError **error)
{
    const size_t n = (size_t)now->parts.n_parts + 1;
    *traces = (Traces){0};
    if (!(traces->before = fl_alloc(n, sizeof *traces->before, "a flow", error)) ||
        !(traces->after = fl_alloc(n, sizeof *traces->after, "a flow", error)) ||
        !(traces->fixed = fl_alloc(n, sizeof *traces->fixed, "a flow", error)))
        return false;
    return fl_part_tracking_find(now, before, limit_px, traces->before, error) &&
           fl_part_tracking_find(now, after, limit_px, traces->after, error);
}

static float length(const float v[2])
{
    return sqrtf(v[0] * v[0] + v[1] * v[1]);
}

/** Normal velocity of the contour of `now` at a pixel, growth being the increase of distance. */
static bool measure(const FlFlowFrame *now, const FlFlowFrame *other, bool other_is_later,
                    float limit_px, int x, int y, float velocity[2])
{
    const int w = now->outline->frame_width, h = now->outline->frame_height;
    const size_t p = y * (size_t)w + x;
    float g[2], g_other[2];
    fl_distance_gradient(now->distance, w, h, x, y, g);
    fl_distance_gradient(other->distance, w, h, x, y, g_other);
    if (g[0] * g_other[0] + g[1] * g_other[1] < 0.0f)
        return false;
    const float *normal = length(g) >= least_gradient ? g : g_other;
    const float norm = length(normal);
    if (norm < least_gradient)
        return false;
    float growth = now->distance[p] - other->distance[p];
    growth = CLAMP(other_is_later ? -growth : growth, -limit_px, limit_px);
    velocity[0] = -growth * normal[0] / norm;
    velocity[1] = -growth * normal[1] / norm;
    return true;
}

/** Velocity of a pixel, if its part jumps or it lies on the contour of one that overlaps. */
static bool find_velocity(const FlFlowFrame *now, const FlFlowFrame *before,
                          const FlFlowFrame *after, const FlTrace *backward, const FlTrace *forward,
                          float limit_px, int x, int y, float velocity[2])
{
    const bool later = backward->kind == FL_TRACE_LOST;
    const FlTrace *trace = later ? forward : backward;
    if (trace->kind == FL_TRACE_JUMPS) {
        velocity[0] = later ? -trace->offset[0] : trace->offset[0];
        velocity[1] = later ? -trace->offset[1] : trace->offset[1];
        return true;
    }
    return trace->kind == FL_TRACE_OVERLAPS && fl_outline_is_contour(now->outline, x, y) &&
           measure(now, later ? after : before, later, limit_px, x, y, velocity);
}

/** Fixes the pixels that have a velocity; the shape's others are free. */
static void fix_velocities(const FlFlowFrame *now, const FlFlowFrame *before,
                           const FlFlowFrame *after, float limit_px, Traces *traces, uint8_t *cell,
                           float *flow)
{
    const FlRect *box = &now->outline->box;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            const size_t p = y * (size_t)box->width + x;
            const int part = now->outline->parts.part[p];
            cell[p] = part > 0 ? FL_CELL_FREE : FL_CELL_OUTSIDE;
            if (part > 0 &&
                find_velocity(now, before, after, &traces->before[part], &traces->after[part],
                              limit_px, box->x + x, box->y + y, flow + 2 * p)) {
                cell[p] = FL_CELL_FIXED;
                traces->fixed[part]++;
            }
        }
}

bool fl_flow_construct(const FlFlowFrame *now, const FlFlowFrame *before, const FlFlowFrame *after,
                       float limit_px, float *flow, bool *moves, GError **error)
{
    const FlRect *box = &now->outline->box;
    const size_t n = fl_rect_pixels(*box);
    g_auto(Traces) traces = {0};
    g_autofree uint8_t *cell = fl_alloc_unset(n, sizeof *cell, "a flow", error);
    if (!cell ||
        !traces_init(&traces, now->outline, before->outline, after->outline, limit_px, error))
        return false;
    memset(flow, 0, 2 * n * sizeof *flow);
    fix_velocities(now, before, after, limit_px, &traces, cell, flow);
    *moves = false;
    for (size_t p = 0; p < n; p++) {
        const int part = now->outline->parts.part[p];
        if (part > 0 && traces.fixed[part] == 0)
            cell[p] = FL_CELL_FIXED; // a part without any velocity stays at rest
        *moves |= flow[2 * p] != 0.0f || flow[2 * p + 1] != 0.0f;
    }
    return !*moves || fl_laplace_solve(cell, box->width, box->height, 2, flow, error);
}

/** Fixes the normals of the contour in columns of row y of the box. Returns: whether any has one.
 */
static bool fix_normals(const FlOutline *outline, int y, FlColumns columns, uint8_t *cell,
                        float *normal)
{
    const FlRect box = outline->box;
    bool any = false;
    for (int x = columns.first; x < columns.last; x++) {
        const size_t p = (size_t)y * (size_t)box.width + (size_t)x;
        float g[2];
        if (outline->coverage[p] < FL_INSIDE)
            continue;
        cell[p] = FL_CELL_FREE;
        if (!fl_outline_is_contour(outline, box.x + x, box.y + y))
            continue;
        fl_distance_gradient(outline->distance, outline->frame_width, outline->frame_height,
                             box.x + x, box.y + y, g);
        const float norm = length(g);
        if (norm < least_gradient)
            continue;
        any = true;
        cell[p] = FL_CELL_FIXED;
        normal[2 * p] = -g[0] / norm;
        normal[2 * p + 1] = -g[1] / norm;
    }
    return any;
}

bool fl_outline_normals(FlOutline *outline, GError **error)
{
    const FlRect *box = &outline->box;
    const size_t n = fl_rect_pixels(*box);
    g_autofree uint8_t *cell = fl_alloc_unset(n, sizeof *cell, "normals", error);
    g_autofree float *normal = fl_alloc_scratch(2 * n, sizeof *normal, "normals", error);
    bool any = false;
    if (!cell || !normal)
        return false;
    memset(cell, FL_CELL_OUTSIDE, n * sizeof *cell);
    for (int y = 0; y < box->height; y++) {
        const uint8_t *row = outline->coverage + (size_t)y * (size_t)box->width;
        for (FlColumns run = fl_next_run(row, 0, box->width); run.first < run.last;
             run = fl_next_run(row, run.last, box->width))
            any |= fix_normals(outline, y, run, cell, normal);
    }
    if (any && !fl_laplace_solve(cell, box->width, box->height, 0, normal, error))
        return false;
    g_free(outline->normal);
    outline->normal = g_steal_pointer(&normal);
    return true;
}
