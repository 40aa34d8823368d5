#include "wet/moving_edge.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/density.h"
#include "guides/distance.h"
#include "wet/fibres.h"
#include <math.h>

#define SPREADS 0.6f // the share of its way that a front still has to go falls so much in a frame
#define BEYOND_PX 5  // px of the page: so far beyond an edge a shape goes on

float fl_wet_absorbance(uint8_t paint, uint8_t paper)
{
    const float density = (float)(fl_density(paint) - fl_density(paper)) / FL_DENSITY_ONE;
    return CLAMP(density * 0.693147181f, 0.0f, 4.0f);
}

static float coverage_at(const FlWetShape *shape, int x, int y)
{
    const FlRect rect = shape->rect;
    const int column = CLAMP(x, 0, rect.width - 1), row = CLAMP(y, 0, rect.height - 1);
    return (float)shape->now[(size_t)row * (size_t)rect.width + (size_t)column] / 255;
}

bool fl_moving_edge_look(FlMovingEdge *edge, const FlWetShape *shape, GError **error)
{
    const size_t n = fl_rect_pixels(shape->rect);
    const int width = shape->rect.width;
    FlContour *contour = &edge->contour;
    *edge = (FlMovingEdge){.rect = shape->rect};
    if (!(edge->distance = fl_alloc_unset(n, sizeof *edge->distance, "an edge", error)) ||
        !fl_distance_to_contour(shape->now, width, shape->rect.height, edge->distance, contour,
                                error))
        return false;
    edge->n = contour->n;
    edge->point = g_new0(FlEdgePoint, MAX(edge->n, 1));
    for (int i = 0; i < edge->n; i++) {
        const FlContourPiece *piece = &contour->piece[i];
        const int32_t pixel = contour->pixel[i];
        edge->point[i] = (FlEdgePoint){.x = (float)(pixel % width),
                                       .y = (float)(pixel / width),
                                       .depth = edge->distance[pixel],
                                       .nx = -piece->nx,
                                       .ny = -piece->ny};
    }
    for (size_t p = 0; p < n; p++)
        if (edge->n == 0 || edge->distance[p] > FL_WET_DEEP_PX * shape->px)
            contour->nearest[p] = -1;
    return true;
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

/** The depth that the place a point comes from had in the frame before; beyond the page the
 * contour is taken to have come along with the motion. */
static float depth_before(const FlWetShape *shape, const FlEdgePoint *point, float u, float v)
{
    const float x = point->x - u, y = point->y - v;
    const float px = (float)shape->rect.x + x, py = (float)shape->rect.y + y;
    const bool seen = px >= 0 && py >= 0 && px <= (float)shape->page.width - 1 &&
                      py <= (float)shape->page.height - 1;
    return seen ? fl_wet_plane_at(shape->distance_before, shape->rect, x, y) : point->depth;
}

/** A point of a shape that spins goes on with the whole shape, as far as that brings the contour to
 * where it was: a ball passes straight on, though its paint turns. */
static void leave_out_spin(const FlWetShape *shape, float u, float v, FlEdgePoint *point)
{
    const float missed = point->depth - depth_before(shape, point, u, v);
    const float share = fl_bell(missed / shape->px);
    point->u += share * (u - point->u), point->v += share * (v - point->v);
}

/** The share of an advance over the contour before that goes the way a point faces: the sides of a
 * stroke that grows at its end do not advance. */
static float find_facing(const FlWetShape *shape, const FlEdgePoint *point)
{
    const float *before = shape->distance_before, x = point->x - point->u, y = point->y - point->v;
    const float inner = fl_wet_plane_at(before, shape->rect, x - point->nx, y - point->ny);
    const float outer = fl_wet_plane_at(before, shape->rect, x + point->nx, y + point->ny);
    return CLAMP((inner - outer) / 2, 0, 1);
}

/** The part of a speed that a point has by its facing; a retreat is whole. */
static float facing_part(float speed, float facing)
{
    return speed > 0 ? facing * speed : speed;
}

/** The normal part of the motion, and growth that the motion does not explain. */
static void find_speed(const FlWetShape *shape, bool known, float facing, FlEdgePoint *point)
{
    const float page = FL_WET_PAGE_PX * shape->px, most = 0.05f * page * shape->frames;
    const float before = depth_before(shape, point, point->u, point->v);
    float ground[2];
    fl_wet_ground(shape, point->x, point->y, ground);
    point->u -= ground[0], point->v -= ground[1];
    const float moved = point->u * point->nx + point->v * point->ny;
    const float grown = facing_part(CLAMP(point->depth - before, -most, most), facing) *
                        (known ? 1 : fl_ease(0.02f, 0.2f, shape->overlap));
    const float speed = (moved + grown) / shape->frames;
    point->speed = CLAMP(speed, -0.12f * page, 0.12f * page);
}

/** The way inwards as far as the contour it began at is the nearest. */
static void find_width(const FlWetShape *shape, const float *distance, FlEdgePoint *point)
{
    const float most = 26 * shape->px;
    float depth = 1;
    while (depth < most && fl_wet_plane_at(distance, shape->rect, point->x - depth * point->nx,
                                           point->y - depth * point->ny) > 0.8f * depth - 1)
        depth++;
    point->half_width = depth;
}

/** Half the length of a shape along its motion, from a point of its trailing edge. */
static float half_way_over(const FlWetShape *shape, const FlEdgePoint *point)
{
    const float most = 52 * shape->px, slow = 0.5f * shape->px;
    const float dx = point->u - slow * point->nx, dy = point->v - slow * point->ny;
    const float length = sqrtf(dx * dx + dy * dy) + 1e-6f;
    float way = 1.5f;
    while (way < most && coverage_at(shape, (int)(point->x + way * dx / length + 0.5f),
                                     (int)(point->y + way * dy / length + 0.5f)) > 0.5f)
        way++;
    return 0.5f * way;
}

/** The share of its paint that the paper keeps: less of thin and fast strokes, also where these
 * turn round and are slow for a frame; none of shapes that shrink without a motion that explains
 * it, more of those that rested. */
static void find_kept(const FlWetShape *shape, float pace_before, FlEdgePoint *point)
{
    const float px = shape->px, width = MAX(half_way_over(shape, point), 2 * px);
    const float moved = sqrtf(point->u * point->u + point->v * point->v);
    const float shrunk = MAX(-point->speed, 0) * shape->frames;
    point->pace = MAX(moved / shape->frames, pace_before * fl_fall(0.3f * shape->frames));
    const float quick = 1.5f * point->pace / width, contact = 1 / (1 + quick * quick);
    const float rested = 0.8f + 0.4f * fl_bell(pace_before / px);
    point->kept = fl_bell(point->pace / (2.2f * width)) * contact * rested *
                  (1 - fl_ease(1.3f, 2, shrunk / (moved + 3 * px)));
}

/** The cell of laid paint at a place of the page, or the nearest at its sides. */
static size_t cell_at(const FlLaid *laid, float x, float y)
{
    const int column = CLAMP((int)floorf(x + 0.5f), 0, laid->width - 1);
    const int row = CLAMP((int)floorf(y + 0.5f), 0, laid->height - 1);
    return (size_t)row * (size_t)laid->width + (size_t)column;
}

/** The ink of the paint a little inside the edge, in the frame before; where the shape has just
 * come, that is inside the nearest earlier edge, and at the side of the page beyond it. A shape
 * that has faded has no ink. Paint below another shape keeps its earlier ink if the other one goes
 * on beyond the edge, and takes the other's if both end there. */
static void find_ink(const FlWetShape *shape, const FlMovingEdge *before, const FlEdgePoint *was,
                     FlEdgePoint *point)
{
    const FlLaid *laid = shape->laid;
    float sum[3] = {0}, weight = 0, ground[2];
    if (shape->ink) {
        memcpy(point->ink, shape->ink, sizeof point->ink);
        return;
    }
    fl_wet_ground(shape, point->x, point->y, ground);
    float x = point->x - point->u - ground[0], y = point->y - point->v - ground[1];
    const bool fresh = was && fl_wet_plane_at(shape->distance_before, shape->rect, x, y) < -1;
    const float nx = fresh ? was->nx : point->nx, ny = fresh ? was->ny : point->ny;
    x = fresh ? (float)before->rect.x + was->x : (float)shape->rect.x + x;
    y = fresh ? (float)before->rect.y + was->y : (float)shape->rect.y + y;
    const float out = BEYOND_PX * shape->px;
    const int beyond = laid->region[cell_at(laid, x + out * nx, y + out * ny)];
    for (int k = 1; k <= 4; k++) {
        const float depth = MIN(2.2f * (float)k * shape->px, 0.8f * point->half_width);
        const size_t cell = cell_at(laid, x - depth * nx, y - depth * ny);
        const int region = laid->region[cell];
        if (region < shape->region)
            continue;
        const bool below = was && region > shape->region && region == beyond;
        for (size_t c = 0; c < 3; c++)
            sum[c] +=
                below ? was->ink[c] : fl_wet_absorbance(laid->rgb[3 * cell + c], shape->paper[c]);
        weight++;
    }
    for (int c = 0; c < 3; c++)
        point->ink[c] = sum[c] / MAX(weight, 1);
}

/** All but the place. */
static float *values_of(FlEdgePoint *point)
{
    return &point->nx;
}

enum { N_VALUES = (sizeof(FlEdgePoint) - offsetof(FlEdgePoint, nx)) / sizeof(float) };

/** Means with the points around, again and again: a Gaussian of about 3 px along the contour. */
static void smooth(const FlWetShape *shape, FlMovingEdge *edge)
{
    const int rounds = CLAMP((int)(14 * shape->px * shape->px), 4, 60);
    FlEdgePoint *next = g_memdup2(edge->point, (size_t)edge->n * sizeof *next);
    for (int k = 0; k < rounds && edge->n > 0; k++) {
        for (int i = 0; i < edge->n; i++) {
            float *to = values_of(&next[i]);
            memcpy(to, values_of(&edge->point[i]), N_VALUES * sizeof *to);
            const int32_t *link = edge->contour.links[i].piece;
            int n = 0;
            for (; n < FL_LINKS && link[n] != i; n++)
                for (int c = 0; c < N_VALUES; c++)
                    to[c] += values_of(&edge->point[link[n]])[c];
            for (int c = 0; c < N_VALUES; c++)
                to[c] /= (float)(n + 1);
        }
        FlEdgePoint *last = edge->point;
        edge->point = next, next = last;
    }
    g_free(next);
}

/** The point of the frame before that is nearest to where a point comes from; NULL: not known. */
static const FlEdgePoint *point_before(const FlWetShape *shape, const FlMovingEdge *before,
                                       const FlEdgePoint *point)
{
    const FlRect was = before->rect;
    float ground[2];
    fl_wet_ground(shape, point->x, point->y, ground);
    const float x = point->x + (float)(shape->rect.x - was.x) - point->u - ground[0];
    const float y = point->y + (float)(shape->rect.y - was.y) - point->v - ground[1];
    if (before->n == 0)
        return NULL;
    const size_t column = (size_t)CLAMP(x + 0.5f, 0, (float)was.width - 1);
    const size_t row = (size_t)CLAMP(y + 0.5f, 0, (float)was.height - 1);
    const int32_t nearest = before->contour.nearest[row * (size_t)was.width + column];
    return nearest >= 0 ? &before->point[nearest] : NULL;
}

/** Finds the motion of each point as far as it is known, and counts these. */
static void find_motions(const FlWetShape *shape, FlMovingEdge *edge, bool *known)
{
    float u = 0, v = 0;
    for (int i = 0; i < edge->n; i++) {
        known[i] = find_motion(shape, &edge->point[i]);
        edge->known += known[i];
        u += edge->point[i].u, v += edge->point[i].v;
    }
    const float n = (float)MAX(edge->known, 1);
    for (int i = 0; i < edge->n; i++)
        if (known[i])
            leave_out_spin(shape, u / n, v / n, &edge->point[i]);
}

/** The share of its full width that a front has by the speed of its edge: it spreads to that in
 * some frames, and shrinks at once. */
static float find_lead(const FlWetShape *shape, float speed, float before)
{
    const float fast = 1 - fl_fall(MAX(speed, 0) / (3.6f * shape->px));
    const float lead = fast * fl_ease(0.06f, 0.5f, fast);
    return MIN(lead, lead + (before - lead) * fl_fall(SPREADS * shape->frames));
}

/** The motion is smoothed in time; strength and ink go over from the frame before. */
static void find_point(const FlWetShape *shape, const FlMovingEdge *before, bool known,
                       const FlMovingEdge *edge, FlEdgePoint *point)
{
    const float facing = find_facing(shape, point);
    find_speed(shape, known, facing, point);
    find_width(shape, edge->distance, point);
    const FlEdgePoint *was = point_before(shape, before, point);
    find_ink(shape, before, was, point);
    const float speed = was ? was->speed : 0;
    find_kept(shape, was ? was->pace : 0, point);
    point->kept_before = was ? was->kept : point->kept;
    memcpy(point->ink_before, was ? was->ink : point->ink, sizeof point->ink);
    point->receding = MAX(-point->speed, 0) * shape->frames;
    point->receded = MAX((was ? was->receded : 0) - point->speed * shape->frames, 0);
    point->speed = 0.55f * point->speed + 0.45f * facing_part(speed, facing);
    point->lead = find_lead(shape, point->speed, was ? was->lead : 0);
}

bool fl_moving_edge_init(FlMovingEdge *edge, const FlWetShape *shape, const FlMovingEdge *before,
                         GError **error)
{
    if (!fl_moving_edge_look(edge, shape, error))
        return false;
    g_autofree bool *known = g_new(bool, MAX(edge->n, 1));
    find_motions(shape, edge, known);
    for (int i = 0; i < edge->n; i++)
        find_point(shape, before, known[i], edge, &edge->point[i]);
    smooth(shape, edge);
    for (int i = 0; i < edge->n; i++)
        edge->fastest = MAX(edge->fastest, fabsf(edge->point[i].speed));
    return true;
}

void fl_moving_edge_clear(FlMovingEdge *edge)
{
    g_free(edge->point);
    fl_contour_clear(&edge->contour);
    free(edge->distance);
    *edge = (FlMovingEdge){0};
}
