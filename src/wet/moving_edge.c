#include "wet/moving_edge.h"

#include "base/alloc.h"
#include "base/density.h"
#include "guides/guides.h"
#include "wet/curves.h"
#include "wet/fibres.h"
#include <math.h>

float fl_wet_absorbance(uint8_t paint, uint8_t paper)
{
    const float density = (float)(fl_density(paint) - fl_density(paper)) / FL_DENSITY_ONE;
    return CLAMP(density * 0.693147181f, 0.0f, 4.0f);
}

/** From a point to those around it. */
typedef struct Links {
    int n;
    int32_t to[8];
} Links;

float fl_wet_plane_at(const float *plane, FlRect rect, float x, float y)
{
    const float cx = CLAMP(x, 0.0f, (float)rect.width - 1.001f);
    const float cy = CLAMP(y, 0.0f, (float)rect.height - 1.001f);
    const int ix = (int)cx, iy = (int)cy;
    const float tx = cx - (float)ix, ty = cy - (float)iy;
    const float *row = plane + (size_t)iy * (size_t)rect.width + ix;
    const float *next = iy + 1 < rect.height ? row + rect.width : row;
    const int right = ix + 1 < rect.width;
    const float upper = row[0] + (row[right] - row[0]) * tx;
    const float lower = next[0] + (next[right] - next[0]) * tx;
    return upper + (lower - upper) * ty;
}

/** Whether a place is not where the page cuts the shape. */
static bool within_page(const FlWetShape *shape, int x, int y)
{
    const int px = shape->rect.x + x, py = shape->rect.y + y;
    return px >= 2 && py >= 2 && px < shape->page.width - 2 && py < shape->page.height - 2;
}

static void find_points(const FlWetShape *shape, GArray *points, int32_t *nearest)
{
    const FlRect rect = shape->rect;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            nearest[p] = -1;
            if (fabsf(shape->distance[p]) >= 0.8f || !within_page(shape, x, y))
                continue;
            const FlEdgePoint point = {.x = (float)x, .y = (float)y};
            nearest[p] = (int32_t)points->len;
            g_array_append_val(points, point);
        }
}

/** Away from the shape; a difference over some pixels, which is smooth. */
static void find_normal(const FlWetShape *shape, FlEdgePoint *point)
{
    const float x = point->x, y = point->y;
    const float nx = fl_wet_plane_at(shape->distance, shape->rect, x - 2, y) -
                     fl_wet_plane_at(shape->distance, shape->rect, x + 2, y);
    const float ny = fl_wet_plane_at(shape->distance, shape->rect, x, y - 2) -
                     fl_wet_plane_at(shape->distance, shape->rect, x, y + 2);
    const float length = sqrtf(nx * nx + ny * ny) + 1e-6f;
    point->nx = nx / length, point->ny = ny / length;
}

/** The motion of the drawing just inside the contour. Returns: false where it is unknown. */
static bool find_motion(const FlWetShape *shape, FlEdgePoint *point)
{
    const FlRect rect = shape->rect;
    for (float depth = 1; shape->motion && depth < 4; depth++) {
        const int x = (int)(point->x - depth * point->nx + 0.5f);
        const int y = (int)(point->y - depth * point->ny + 0.5f);
        if (x < 0 || y < 0 || x >= rect.width || y >= rect.height)
            continue;
        const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
        if (shape->now[p] < FL_INSIDE || isnan(shape->motion[2 * p]))
            continue;
        point->u = shape->motion[2 * p], point->v = shape->motion[2 * p + 1];
        return true;
    }
    return false;
}

/** The normal part of the motion, and growth that the motion does not explain. */
static void find_speed(const FlWetShape *shape, FlEdgePoint *point, bool known)
{
    const float page = FL_WET_PAGE_PX * shape->px, most = 0.05f * page * shape->frames;
    const float now = fl_wet_plane_at(shape->distance, shape->rect, point->x, point->y);
    const float before = fl_wet_plane_at(shape->distance_before, shape->rect, point->x - point->u,
                                         point->y - point->v);
    point->u -= shape->ground_x, point->v -= shape->ground_y;
    const float moved = point->u * point->nx + point->v * point->ny;
    const float grown =
        CLAMP(now - before, -most, most) * (known ? 1 : fl_ease(0.02f, 0.2f, shape->overlap));
    const float speed = (moved + grown) / shape->frames;
    point->speed = CLAMP(speed, -0.12f * page, 0.12f * page);
}

/** The way inwards as far as the contour it began at is the nearest. */
static void find_width(const FlWetShape *shape, FlEdgePoint *point)
{
    const float most = 26 * shape->px;
    float depth = 1;
    while (depth < most &&
           fl_wet_plane_at(shape->distance, shape->rect, point->x - depth * point->nx,
                           point->y - depth * point->ny) > 0.8f * depth - 1)
        depth++;
    point->half_width = depth;
}

bool fl_wet_ink_at(const FlWetShape *shape, float x, float y, float ink[3])
{
    const FlLaid *laid = shape->laid;
    const int px = shape->rect.x + (int)floorf(x + 0.5f),
              py = shape->rect.y + (int)floorf(y + 0.5f);
    memcpy(ink, shape->fill, sizeof shape->fill);
    if (!laid || px < 0 || py < 0 || px >= laid->width || py >= laid->height)
        return false;
    const size_t cell = (size_t)py * (size_t)laid->width + (size_t)px;
    if (laid->region[cell] != shape->region)
        return false;
    for (size_t c = 0; c < 3; c++)
        ink[c] = fl_wet_absorbance(laid->rgb[3 * cell + c], shape->paper[c]);
    return true;
}

/** The paint some way inside, as it was laid in the frame before. */
static void find_ink(const FlWetShape *shape, FlEdgePoint *point)
{
    float sum[3] = {0}, weight = 0;
    for (int k = 1; k <= 4; k++) {
        const float depth = MIN(2.2f * (float)k * shape->px, 0.8f * point->half_width);
        const float x = point->x - depth * point->nx - point->u - shape->ground_x;
        const float y = point->y - depth * point->ny - point->v - shape->ground_y;
        float ink[3];
        if (!fl_wet_ink_at(shape, x, y, ink))
            continue;
        for (int c = 0; c < 3; c++)
            sum[c] += ink[c];
        weight++;
    }
    for (int c = 0; c < 3; c++)
        point->ink[c] = weight > 0 ? sum[c] / weight : shape->fill[c];
}

static void link_points(FlRect rect, const GArray *points, const int32_t *nearest, Links *links)
{
    for (guint i = 0; i < points->len; i++) {
        const FlEdgePoint *point = &g_array_index(points, FlEdgePoint, i);
        const int px = (int)point->x, py = (int)point->y;
        for (int y = MAX(py - 1, 0); y <= MIN(py + 1, rect.height - 1); y++)
            for (int x = MAX(px - 1, 0); x <= MIN(px + 1, rect.width - 1); x++) {
                const int32_t other = nearest[(size_t)y * (size_t)rect.width + (size_t)x];
                if (other >= 0 && other != (int32_t)i)
                    links[i].to[links[i].n++] = other;
            }
    }
}

/** All but the place. */
static float *values_of(FlEdgePoint *point)
{
    return &point->nx;
}

enum { N_VALUES = (sizeof(FlEdgePoint) - offsetof(FlEdgePoint, nx)) / sizeof(float) };

/** Means with the points around, again and again: a Gaussian of about 3 px along the contour. */
static void smooth(const FlWetShape *shape, GArray *points, const Links *links)
{
    if (points->len == 0)
        return;
    const int rounds = CLAMP((int)(14 * shape->px * shape->px), 4, 60);
    g_autofree FlEdgePoint *next = g_memdup2(points->data, points->len * sizeof *next);
    for (int k = 0; k < rounds; k++) {
        FlEdgePoint *from = &g_array_index(points, FlEdgePoint, 0);
        for (guint i = 0; i < points->len; i++) {
            float *to = values_of(&next[i]);
            memcpy(to, values_of(&from[i]), N_VALUES * sizeof *to);
            for (int l = 0; l < links[i].n; l++)
                for (int c = 0; c < N_VALUES; c++)
                    to[c] += values_of(&from[links[i].to[l]])[c];
            for (int c = 0; c < N_VALUES; c++)
                to[c] /= (float)(links[i].n + 1);
        }
        memcpy(points->data, next, points->len * sizeof *next);
    }
}

static void take(const FlEdgePoint *points, int32_t *nearest, size_t p, size_t other, int x, int y)
{
    const int32_t candidate = nearest[other];
    if (candidate < 0)
        return;
    const FlEdgePoint *a = &points[candidate];
    const float ax = (float)x - a->x, ay = (float)y - a->y;
    if (nearest[p] >= 0) {
        const FlEdgePoint *b = &points[nearest[p]];
        const float bx = (float)x - b->x, by = (float)y - b->y;
        if (bx * bx + by * by <= ax * ax + ay * ay)
            return;
    }
    nearest[p] = candidate;
}

/** One way over the rows: from those that came before, then along each row, both ways. */
static void sweep(const FlEdgePoint *points, const FlWetShape *shape, bool down, int32_t *nearest)
{
    const FlRect rect = shape->rect;
    const int width = rect.width;
    const float deep = FL_WET_DEEP_PX * shape->px;
    for (int k = 0; k < rect.height; k++) {
        const int y = down ? k : rect.height - 1 - k;
        const size_t row = (size_t)y * (size_t)width;
        const size_t last = down ? row - (size_t)width : row + (size_t)width;
        for (int x = 0; x < width; x++) {
            const size_t p = row + (size_t)x;
            if (shape->distance[p] > deep)
                continue;
            for (int dx = -1; dx <= 1 && k > 0; dx++)
                if (x + dx >= 0 && x + dx < width)
                    take(points, nearest, p, last + (size_t)(x + dx), x, y);
            if (x > 0)
                take(points, nearest, p, p - 1, x, y);
        }
        for (int x = width - 2; x >= 0; x--)
            if (shape->distance[row + (size_t)x] <= deep)
                take(points, nearest, row + (size_t)x, row + (size_t)x + 1, x, y);
    }
}

/** Smooths the speed in time, along the motion. */
static void follow(const FlWetShape *shape, const FlEdgeBefore *before, FlEdgePoint *point)
{
    float speed = 0;
    const FlRect was = before->rect;
    const float x = point->x + (float)(shape->rect.x - was.x) - point->u - shape->ground_x;
    const float y = point->y + (float)(shape->rect.y - was.y) - point->v - shape->ground_y;
    if (before->speed)
        speed = fl_wet_plane_at(before->speed, was, x, y);
    point->speed = 0.55f * point->speed + 0.45f * speed;
    point->speed_before = speed;
}

bool fl_edge_before_take(FlEdgeBefore *before, const FlWetShape *shape, const FlMovingEdge *edge,
                         GError **error)
{
    const size_t n = fl_rect_pixels(shape->rect);
    fl_edge_before_clear(before);
    before->rect = shape->rect;
    if (!(before->distance = fl_alloc_unset(n, sizeof(float), "an edge", error)) ||
        !(before->speed = fl_alloc_unset(n, sizeof(float), "an edge", error)))
        return false;
    memcpy(before->distance, shape->distance, n * sizeof(float));
    for (size_t p = 0; p < n; p++)
        before->speed[p] = edge->nearest[p] >= 0 ? edge->point[edge->nearest[p]].speed : 0;
    return true;
}

static void find_all(const FlWetShape *shape, GArray *points, const int32_t *nearest,
                     const FlEdgeBefore *before)
{
    g_autofree Links *links = g_new0(Links, MAX(points->len, 1));
    for (guint i = 0; i < points->len; i++) {
        FlEdgePoint *point = &g_array_index(points, FlEdgePoint, i);
        find_normal(shape, point);
        find_speed(shape, point, find_motion(shape, point));
        find_width(shape, point);
        find_ink(shape, point);
        follow(shape, before, point);
    }
    link_points(shape->rect, points, nearest, links);
    smooth(shape, points, links);
}

bool fl_moving_edge_init(FlMovingEdge *edge, const FlWetShape *shape, const FlEdgeBefore *before,
                         GError **error)
{
    *edge = (FlMovingEdge){0};
    edge->nearest =
        fl_alloc_unset(fl_rect_pixels(shape->rect), sizeof *edge->nearest, "an edge", error);
    if (!edge->nearest)
        return false;
    GArray *points = g_array_new(FALSE, TRUE, sizeof(FlEdgePoint));
    find_points(shape, points, edge->nearest);
    find_all(shape, points, edge->nearest, before);
    edge->n = (int)points->len;
    edge->point = (FlEdgePoint *)(void *)g_array_free(points, FALSE);
    for (int i = 0; i < edge->n; i++)
        edge->fastest = MAX(edge->fastest, fabsf(edge->point[i].speed));
    if (edge->n > 0) {
        sweep(edge->point, shape, true, edge->nearest);
        sweep(edge->point, shape, false, edge->nearest);
    }
    return true;
}

void fl_moving_edge_clear(FlMovingEdge *edge)
{
    g_free(edge->point);
    free(edge->nearest);
    *edge = (FlMovingEdge){0};
}

void fl_edge_before_clear(FlEdgeBefore *before)
{
    free(before->distance);
    free(before->speed);
    *before = (FlEdgeBefore){0};
}
