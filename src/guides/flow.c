#include "guides/flow.h"

#include "guides/guides.h"
#include "guides/laplace.h"
#include "guides/parts.h"
#include <math.h>
#include <string.h>

static const float least_gradient = 0.25f; // below it a gradient has no direction

/** Which interval a part of the shape takes its motion from. */
typedef enum Interval { INTERVAL_NONE, INTERVAL_BEFORE, INTERVAL_AFTER } Interval;

static bool is_there(const FlFlowFrame *frame)
{
    return frame->outline && !frame->outline->empty;
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

/** Chooses the interval of every part: does the other frame have a pixel of it? */
static void choose_intervals(const FlOutline *outline, const FlParts *parts,
                             const FlFlowFrame *other, Interval interval, uint8_t *chosen)
{
    const FlBox *box = &outline->box;
    if (!is_there(other))
        return;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            const int part = parts->part[y * (size_t)box->width + x];
            if (part > 0 && chosen[part] == INTERVAL_NONE &&
                fl_outline_contains(other->outline, box->x + x, box->y + y))
                chosen[part] = interval;
        }
}

/** Sets the contour pixels that tell a velocity; counts them per part in fixed. */
static void fix_contour(const FlFlowFrame *now, const FlFlowFrame *before, const FlFlowFrame *after,
                        float limit_px, const FlParts *parts, const uint8_t *chosen, uint8_t *cell,
                        float *flow, uint32_t *fixed)
{
    const FlBox *box = &now->outline->box;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            const size_t p = y * (size_t)box->width + x;
            const int fx = box->x + x, fy = box->y + y, part = parts->part[p];
            cell[p] = part > 0 ? FL_CELL_FREE : FL_CELL_OUTSIDE;
            if (part == 0 || chosen[part] == INTERVAL_NONE ||
                !fl_outline_is_contour(now->outline, fx, fy))
                continue;
            const bool later = chosen[part] == INTERVAL_AFTER;
            if (!measure(now, later ? after : before, later, limit_px, fx, fy, flow + 2 * p))
                continue;
            cell[p] = FL_CELL_FIXED;
            fixed[part]++;
        }
}

bool fl_flow_construct(const FlFlowFrame *now, const FlFlowFrame *before, const FlFlowFrame *after,
                       float limit_px, float *flow, bool *moves, GError **error)
{
    const FlBox *box = &now->outline->box;
    const size_t n = fl_box_area(box);
    g_auto(FlParts) parts = {0};
    g_autofree uint8_t *cell = g_try_malloc(n);
    if (!cell) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for a flow");
        return false;
    }
    if (!fl_parts_init(&parts, now->outline->coverage, box->width, box->height, error))
        return false;
    memset(flow, 0, 2 * n * sizeof *flow);
    g_autofree uint8_t *chosen = g_new0(uint8_t, parts.n_parts + 1);
    g_autofree uint32_t *fixed = g_new0(uint32_t, parts.n_parts + 1);
    choose_intervals(now->outline, &parts, before, INTERVAL_BEFORE, chosen);
    choose_intervals(now->outline, &parts, after, INTERVAL_AFTER, chosen);
    fix_contour(now, before, after, limit_px, &parts, chosen, cell, flow, fixed);
    for (size_t p = 0; p < n; p++) // a part that nothing is known of stays at rest
        if (parts.part[p] > 0 && fixed[parts.part[p]] == 0)
            cell[p] = FL_CELL_FIXED;
    *moves = false;
    for (size_t k = 0; k < 2 * n && !*moves; k++)
        *moves = flow[k] != 0.0f;
    return !*moves || fl_laplace_solve(cell, box->width, box->height, flow, error);
}

bool fl_outline_normals(FlOutline *outline, GError **error)
{
    const FlBox *box = &outline->box;
    const size_t n = fl_box_area(box);
    g_autofree uint8_t *cell = g_try_malloc(n);
    g_autofree float *normal = g_try_new0(float, 2 * n);
    if (!cell || !normal) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for normals");
        return false;
    }
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++) {
            const size_t p = y * (size_t)box->width + x;
            float g[2];
            cell[p] = outline->coverage[p] >= FL_INSIDE ? FL_CELL_FREE : FL_CELL_OUTSIDE;
            if (!fl_outline_is_contour(outline, box->x + x, box->y + y))
                continue;
            fl_distance_gradient(outline->distance, outline->frame_width, outline->frame_height,
                                 box->x + x, box->y + y, g);
            const float norm = length(g);
            if (norm < least_gradient)
                continue;
            cell[p] = FL_CELL_FIXED;
            normal[2 * p] = -g[0] / norm;
            normal[2 * p + 1] = -g[1] / norm;
        }
    if (!fl_laplace_solve(cell, box->width, box->height, normal, error))
        return false;
    g_free(outline->normal);
    outline->normal = g_steal_pointer(&normal);
    return true;
}
