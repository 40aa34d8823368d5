#include "guides/registration.h"

#include "base/alloc.h"
#include "base/modes.h"
#include "guides/blur.h"
#include "guides/flow.h"
#include "guides/laplace.h"
#include "guides/part_tracking.h"
#include <math.h>
#include <string.h>

#define MOST_STEPS 12     // of Gauss and Newton
#define CONVERGED_PX 1e-3 // a shorter step ends the search
#define SOFT_PX 3.0       // distances beyond it count less
#define FIRM 0.002        // ridge of translation and rotation: what cannot be seen stays 0
#define STIFF 0.06        // of scale and shears
#define NOISE_PX 0.05     // mean distance that counts as no motion
#define BLUR_PX 0.7f      // of the distances before they are matched
#define LEAST_POINTS 12   // of a contour
#define LIMIT_SHARE 0.25f // of the larger side that a part may move
#define ALIKE 0.1 // of its size that the contour of a part that jumped may be off on average

/** A point of the contour, px between pixel centres, with its pixel and its inward normal. */
typedef struct Point {
    double x, y, nx, ny;
    int px, py;
    double d; // distance at its source in the frame before
} Point;

typedef struct Work {
    int width, height;
    FlOutline *before, *now; // borrowed
    FlRect *part_box;        // in the frame, by part
    FlTrace *trace;
    float *smooth; // the blurred distance before
    float *flow;   // of the masks, made when first needed
    float *motion;
} Work;

static void work_clear(Work *w)
{
    g_free(w->part_box);
    g_free(w->trace);
    g_free(w->smooth);
    g_free(w->flow);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Work, work_clear)

/** The part that a pixel of the frame belongs to. */
static int part_at(const Work *w, int x, int y)
{
    const FlRect box = w->now->box;
    return w->now->parts.part[(size_t)(y - box.y) * box.width + (x - box.x)];
}

/** Bilinear distance before at a place, and its gradient. */
static double sample(const Work *w, double x, double y, double g[2])
{
    x = CLAMP(x, 0, w->width - 1.0), y = CLAMP(y, 0, w->height - 1.0);
    const int ix = MIN((int)x, MAX(w->width - 2, 0)), iy = MIN((int)y, MAX(w->height - 2, 0));
    const int right = MIN(ix + 1, w->width - 1) - ix, down = MIN(iy + 1, w->height - 1) - iy;
    const double u = x - ix, v = y - iy;
    const float *p = w->smooth + (size_t)iy * w->width + ix;
    const double a = p[0], b = p[right], c = p[(size_t)down * w->width];
    const double d = p[(size_t)down * w->width + right];
    g[0] = (b - a) * (1 - v) + (d - c) * v;
    g[1] = (c - a) * (1 - u) + (d - b) * u;
    return (a * (1 - u) + b * u) * (1 - v) + (c * (1 - u) + d * u) * v;
}

/** The contours of all parts: arrays of Point by number; to be freed with g_ptr_array_unref(). */
static GPtrArray *find_points(const Work *w)
{
    const FlRect box = w->now->box;
    GPtrArray *all = g_ptr_array_new_with_free_func((GDestroyNotify)g_array_unref);
    for (int part = 0; part <= w->now->parts.n_parts; part++)
        g_ptr_array_add(all, g_array_new(FALSE, FALSE, sizeof(Point)));
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const int px = box.x + x, py = box.y + y, part = part_at(w, px, py);
            float g[2];
            if (part == 0 || !fl_outline_is_contour(w->now, px, py))
                continue;
            fl_distance_gradient(w->now->distance, w->width, w->height, px, py, g);
            const double length = sqrt((double)g[0] * g[0] + (double)g[1] * g[1]);
            if (length < 0.25)
                continue;
            const double nx = g[0] / length, ny = g[1] / length;
            const double d = w->now->distance[(size_t)py * w->width + px];
            const Point point = {px - d * nx, py - d * ny, nx, ny, px, py, 0};
            g_array_append_val((GArray *)g_ptr_array_index(all, part), point);
        }
    return all;
}

/** The frame of a part's motion. */
static FlAffineMotion map_of(const GArray *points)
{
    FlAffineMotion map = {0};
    for (guint i = 0; i < points->len; i++) {
        const Point *q = &g_array_index(points, Point, i);
        map.x += q->x / points->len, map.y += q->y / points->len;
    }
    for (guint i = 0; i < points->len; i++) {
        const Point *q = &g_array_index(points, Point, i);
        const double x = q->x - map.x, y = q->y - map.y;
        map.size += (x * x + y * y) / points->len;
    }
    map.size = MAX(sqrt(map.size), 1.0);
    return map;
}

/** The mean distance that is left; sets those of the points. */
static double measure(const Work *w, const FlAffineMotion *map, GArray *points)
{
    double sum = 0;
    for (guint i = 0; i < points->len; i++) {
        Point *q = &g_array_index(points, Point, i);
        double u[2], g[2];
        fl_affine_motion_at(map, q->x, q->y, u);
        q->d = sample(w, q->x - u[0], q->y - u[1], g);
        sum += fabs(q->d);
    }
    return sum / points->len;
}

/** One step; false if the equations do not tell. */
static bool improve(const Work *w, FlAffineMotion *map, const GArray *points, double *step)
{
    FlLeastSquares sum = {0};
    for (guint i = 0; i < points->len; i++) {
        const Point *q = &g_array_index(points, Point, i);
        double u[2], g[2];
        fl_affine_motion_at(map, q->x, q->y, u);
        const double d = sample(w, q->x - u[0], q->y - u[1], g);
        fl_affine_motion_add(map, q->x, q->y, g, d, 1 / (1 + d * d / (SOFT_PX * SOFT_PX)), &sum);
    }
    for (int k = 0; k < FL_MODES; k++)
        fl_least_squares_ridge(&sum, k, points->len * (k < 3 ? FIRM : STIFF));
    double p[FL_MODES];
    if (!fl_least_squares_solve(&sum, p))
        return false;
    *step = 0;
    for (int k = 0; k < FL_MODES; k++)
        *step = MAX(*step, fabs(p[k] - map->p[k]));
    memcpy(map->p, p, sizeof p);
    return true;
}

/** Finds the map from a start. Returns: the mean distance that remains, HUGE_VAL without a map. */
static double search(const Work *w, FlAffineMotion *map, GArray *points)
{
    double step = HUGE_VAL;
    for (int k = 0; k < MOST_STEPS && step > CONVERGED_PX; k++)
        if (!improve(w, map, points, &step))
            return HUGE_VAL;
    return measure(w, map, points);
}

/** Fixes what is left of the normal motion on the contour, and diffuses it over the part. */
static bool fill_part(const Work *w, int part, const FlAffineMotion *map, const GArray *points,
                      GError **error)
{
    const FlRect box = w->part_box[part];
    const size_t n = fl_rect_pixels(box);
    g_autofree uint8_t *cell = fl_alloc(n, 1, "a motion", error);
    g_autofree float *rest =
        cell ? fl_alloc_scratch(2 * n, sizeof(float), "a motion", error) : NULL;
    if (!rest)
        return false;
    for (size_t p = 0; p < n; p++) {
        const int x = box.x + (int)(p % box.width), y = box.y + (int)(p / box.width);
        cell[p] = part_at(w, x, y) == part ? FL_CELL_FREE : FL_CELL_OUTSIDE;
    }
    for (guint i = 0; i < points->len; i++) {
        const Point *q = &g_array_index(points, Point, i);
        double u[2], g[2];
        fl_affine_motion_at(map, q->x, q->y, u);
        const double d = sample(w, q->x - u[0], q->y - u[1], g);
        if (g[0] * q->nx + g[1] * q->ny < 0) // faces the other way: no measure of motion
            continue;
        const size_t p = (size_t)(q->py - box.y) * box.width + (q->px - box.x);
        cell[p] = FL_CELL_FIXED;
        rest[2 * p] = (float)(q->nx * d), rest[2 * p + 1] = (float)(q->ny * d);
    }
    if (!fl_laplace_solve(cell, box.width, box.height, 2, rest, error))
        return false;
    for (size_t p = 0; p < n; p++) {
        const int x = box.x + (int)(p % box.width), y = box.y + (int)(p / box.width);
        if (part_at(w, x, y) != part)
            continue;
        double u[2];
        fl_affine_motion_at(map, x, y, u);
        float *out = w->motion + 2 * ((size_t)y * w->width + x);
        out[0] = (float)u[0] + rest[2 * p], out[1] = (float)u[1] + rest[2 * p + 1];
    }
    return true;
}

/** Leaves it open how a part moved: its paint spreads as the masks show. */
static void leave_unknown(const Work *w, int part)
{
    const FlRect box = w->part_box[part];
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++)
            if (part_at(w, x, y) == part) {
                float *out = w->motion + 2 * ((size_t)y * w->width + x);
                out[0] = out[1] = NAN;
            }
}

/** Gives a part the flow of the masks. */
static bool fill_flow(Work *w, int part, GError **error)
{
    const FlRect box = w->now->box;
    const FlFlowFrame now = {w->now, w->now->distance}, before = {w->before, w->before->distance};
    const FlFlowFrame none = {NULL, NULL};
    bool moves = false;
    if (!w->flow) {
        w->flow = fl_alloc(2 * fl_rect_pixels(box), sizeof(float), "a flow", error);
        const float limit = LIMIT_SHARE * (float)MAX(w->width, w->height);
        if (!w->flow || !fl_flow_construct(&now, &before, &none, limit, w->flow, &moves, error))
            return false;
    }
    const FlRect of_part = w->part_box[part];
    for (int y = of_part.y; y < of_part.y + of_part.height; y++)
        for (int x = of_part.x; x < of_part.x + of_part.width; x++)
            if (part_at(w, x, y) == part)
                memcpy(w->motion + 2 * ((size_t)y * w->width + x),
                       w->flow + 2 * ((size_t)(y - box.y) * box.width + (x - box.x)),
                       2 * sizeof(float));
    return true;
}

/** A part that has come as its centre has. */
static FlAffineMotion start_of(const Work *w, int part, const GArray *points)
{
    FlAffineMotion map = map_of(points);
    map.p[0] = (double)w->trace[part].offset[0], map.p[1] = (double)w->trace[part].offset[1];
    return map;
}

/** A part that is nowhere over its past: it has come from there only if it looks the same. A speck
 * looks like any other, so that its motion is unknown. */
static bool register_jump(const Work *w, int part, GArray *points, GError **error)
{
    FlAffineMotion map = start_of(w, part, points);
    if (points->len >= LEAST_POINTS && search(w, &map, points) <= ALIKE * map.size)
        return fill_part(w, part, &map, points, error);
    leave_unknown(w, part);
    return true;
}

static bool register_part(Work *w, int part, GArray *points, GError **error)
{
    if (w->trace[part].kind == FL_TRACE_JUMPS)
        return register_jump(w, part, points, error);
    if (w->trace[part].kind == FL_TRACE_LOST) {
        leave_unknown(w, part);
        return true;
    }
    if (points->len < LEAST_POINTS)
        return fill_flow(w, part, error);
    FlAffineMotion map = map_of(points);
    const double start = measure(w, &map, points);
    if (start < NOISE_PX)
        return true;
    FlAffineMotion far = start_of(w, part, points);
    double left = search(w, &map, points);
    if (far.p[0] != 0 || far.p[1] != 0) {
        const double other = search(w, &far, points);
        if (other < left)
            left = other, map = far;
    }
    return left <= start / 2 ? fill_part(w, part, &map, points, error) : fill_flow(w, part, error);
}

/** Gives the faint pixels around the shape the motion of a neighbour that is inside. */
static void fill_rim(const Work *w)
{
    const FlRect box = w->now->box;
    for (int y = box.y; y < box.y + box.height; y++)
        for (int x = box.x; x < box.x + box.width; x++) {
            float *out = w->motion + 2 * ((size_t)y * w->width + x);
            if (fl_outline_contains(w->now, x, y) ||
                w->now->coverage[(size_t)(y - box.y) * box.width + x - box.x] == 0)
                continue;
            for (int k = 0; k < 9; k++) {
                const int nx = x + k % 3 - 1, ny = y + k / 3 - 1;
                if (!fl_outline_contains(w->now, nx, ny))
                    continue;
                memcpy(out, w->motion + 2 * ((size_t)ny * w->width + nx), 2 * sizeof *out);
                break;
            }
        }
}

static bool prepare(Work *w, GError **error)
{
    const size_t n = (size_t)w->width * w->height;
    w->smooth = fl_alloc(n, sizeof(float), "a distance", error);
    if (!w->smooth)
        return false;
    memcpy(w->smooth, w->before->distance, n * sizeof(float));
    const float limit = LIMIT_SHARE * (float)MAX(w->width, w->height);
    if (!fl_blur(w->smooth, w->width, w->height, BLUR_PX, error))
        return false;
    const FlConnectedParts *parts = &w->now->parts;
    w->part_box = g_new(FlRect, parts->n_parts + 1);
    fl_boxes_of_labels(parts->part, w->now->box, parts->n_parts, w->part_box);
    w->trace = g_new0(FlTrace, parts->n_parts + 1);
    return fl_part_tracking_find(w->now, w->before, limit, w->trace, error);
}

bool fl_registration(FlOutline *before, FlOutline *now, float *motion, GError **error)
{
    const int width = now->frame_width, height = now->frame_height;
    memset(motion, 0, 2 * (size_t)width * height * sizeof *motion);
    if (before->empty || now->empty || fl_outlines_alike(before, now))
        return true;
    g_auto(Work) w = {width, height, before, now, .motion = motion};
    if (!prepare(&w, error))
        return false;
    g_autoptr(GPtrArray) points = find_points(&w);
    for (int part = 1; part <= now->parts.n_parts; part++)
        if (!register_part(&w, part, g_ptr_array_index(points, part), error))
            return false;
    fill_rim(&w);
    return true;
}
