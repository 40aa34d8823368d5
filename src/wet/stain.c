#include "wet/marks.h"

#include "base/curves.h"
#include <math.h>
#include <string.h>

/** A pixel that paint may have left, in the time since the frame before. */
typedef struct Passing {
    const FlWetShape *shape;
    const FlEdgePoint *point; // the nearest of the contour
    const float *distance;    // of the shape as it is now
    float inset;              // paint ends so far inside its shape, cells
    float x, y;
    float before_x, before_y; // its place a frame before
    float touched;            // as in FlWetAround
} Passing;

#define MOST_STEPS 12

/** The depth of the pixel below the painted edge at a time from 0, the frame before, to 1: between
 * that of both shapes, each moved to where it is at the time. */
static float depth_at(const Passing *pixel, float time)
{
    const FlWetShape *shape = pixel->shape;
    const float x = pixel->x, y = pixel->y, u = pixel->point->u, v = pixel->point->v;
    const float before = fl_wet_plane_at(shape->distance_before, shape->rect,
                                         pixel->before_x - time * u, pixel->before_y - time * v);
    const float now =
        fl_wet_plane_at(pixel->distance, shape->rect, x + (1 - time) * u, y + (1 - time) * v);
    return before + time * (now - before) - pixel->inset;
}

/** The times at which a pixel was covered. */
typedef struct Cover {
    float most; // its greatest depth
    float when; // of that
    float last; // time at which paint left the pixel
} Cover;

static Cover cover_in_time(const Passing *pixel, float moved)
{
    const int steps = CLAMP((int)ceilf(moved / (3 * pixel->shape->px)), 1, MOST_STEPS);
    float later = depth_at(pixel, 1);
    Cover cover = {-1e6f, 0, -1};
    for (int k = steps - 1; k >= 0; k--) {
        const float depth = depth_at(pixel, (float)k / (float)steps);
        if (cover.last < 0 && depth > 0) {
            const float crossed = depth / MAX(depth - later, 1e-3f);
            cover.last = ((float)k + CLAMP(crossed, 0, 1)) / (float)steps;
        }
        if (depth >= cover.most)
            cover.most = depth, cover.when = (float)k / (float)steps;
        later = depth;
    }
    if (cover.last < 0)
        cover.last = cover.when;
    return cover;
}

/** The depth of a pixel between the sides of the way that paint takes over it: the greatest in the
 * shape as it is now, of all places that the pixel would come to if it went with the edge. */
static float depth_between_sides(const Passing *pixel)
{
    enum { LOOKS = 8 };
    const FlEdgePoint *point = pixel->point;
    const float more =
        point->speed * pixel->shape->frames - (point->u * point->nx + point->v * point->ny);
    const float u = point->u + more * point->nx, v = point->v + more * point->ny;
    const float far = 2.5f * MAX(point->half_width, 1) / sqrtf(u * u + v * v + 1e-6f);
    float most = -1e6f;
    for (int k = 1; k <= LOOKS; k++) {
        const float way = far * (float)k / LOOKS;
        most = MAX(most, fl_wet_plane_at(pixel->distance, pixel->shape->rect, pixel->x + way * u,
                                         pixel->y + way * v));
    }
    return most - pixel->inset;
}

static float cover_of(float depth)
{
    return CLAMP(depth + 0.5f, 0, 1);
}

/** 1 where a stain takes the place of fronts; near its sides, where it breaks up, they stay and dry
 * by themselves. */
static float away_from_sides(const FlWetShape *shape, float depth)
{
    return fl_ease(0, 8 * shape->px, depth);
}

#define BROAD_PX 34 // px of the page: half the width from which on a stain breaks up as deep as any
#define DEEP_PX 14  // px of the page: deeper inside, no stain breaks up
#define BEGINS 0.7f // depth of a stain, by the way from the place where it begins

/** The depth of a pixel inside the stain, which breaks up towards its sides and its beginning. The
 * stain of a narrow shape breaks up less deep. */
static float depth_of_stain(const Passing *pixel, float between, float receded)
{
    const FlWetShape *shape = pixel->shape;
    const float stretch = CLAMP(BROAD_PX * shape->px / MAX(shape->half_width, 1), 1, 2);
    return CLAMP(stretch * MIN(between, BEGINS * receded), -2,
                 DEEP_PX * shape->px * pixel->touched);
}

/** The strength of the stain at a pixel. */
static float stain_at(const Passing *pixel, const FlWetDials *dials)
{
    const size_t p = (size_t)pixel->y * (size_t)pixel->shape->rect.width + (size_t)pixel->x;
    return dials->stain_map ? dials->stain * dials->stain_map[p] : dials->stain;
}

/** A mark lasts from the frame before to this one, and so do its strength and its ink: in one piece
 * with the marks of the frames around, unless the shape leaps away. */
static void pass(const Passing *pixel, const FlWetDials *dials, int32_t at, float now,
                 GArray *marks)
{
    const FlWetShape *shape = pixel->shape;
    const FlEdgePoint *point = pixel->point;
    const float moved = sqrtf(point->u * point->u + point->v * point->v);
    const Cover cover = cover_in_time(pixel, moved);
    if (cover.most < -1.2f || cover.most < now + 0.01f)
        return;
    const float far = MAX(-now, 0) / (moved + 3 * shape->px);
    const float receded = point->receded - point->receding * (1 - cover.last);
    const float between = MAX(cover.most, depth_between_sides(pixel));
    const float depth = depth_of_stain(pixel, between, receded);
    const float kept =
        (1 - fl_ease(1.3f, 2, far)) * fl_wet_between(point->kept_before, point->kept, cover.last);
    const float sides = fl_ease(0, 0.25f, kept) * (1 - away_from_sides(shape, depth));
    FlStainMark mark = {.at = at,
                        .lost =
                            pixel->touched * (cover_of(cover.most) - cover_of(now)) * (1 - sides),
                        .age = shape->frames * (1 - cover.last),
                        .depth = depth};
    mark.charge =
        stain_at(pixel, dials) * kept * (1 - cover_of(now)) * fl_ease(0, 0.1f, cover.most - now);
    for (int c = 0; c < 3; c++)
        mark.ink[c] = fl_wet_between(point->ink_before[c], point->ink[c], cover.last);
    const float black = MIN(MIN(mark.ink[0], mark.ink[1]), mark.ink[2]);
    for (int c = 0; c < 3; c++) // a thin stain of black is grey
        mark.ink[c] /= 1 + 0.6f * black;
    g_array_append_val(marks, mark);
}

/** 0..1: an edge recedes. */
static float recedes(const FlWetShape *shape, const FlEdgePoint *point)
{
    return 1 - fl_fall(point->receding / (2 * shape->frames * shape->px));
}

/** The stain begins below the rim of a receding edge, whose holes then show no bare paper. */
static float under(const FlWetShape *shape, const FlEdgePoint *point)
{
    return recedes(shape, point) * MIN(6 * shape->px, 0.4f * point->half_width);
}

/** Wets a cell below the rim of a receding edge until it is uncovered: a hole there shows paint. */
static void wet_below(const Passing *pixel, const FlWetDials *dials, int32_t at, float depth,
                      GArray *fronts)
{
    const float kept = MIN(stain_at(pixel, dials) * pixel->point->kept, 1);
    const float between = depth_of_stain(pixel, depth_between_sides(pixel), pixel->point->receded);
    const float away = away_from_sides(pixel->shape, between);
    FlFrontMark mark = {.at = at, .density = kept * away * cover_of(depth), .edge = 3};
    memcpy(mark.ink, pixel->point->ink, sizeof mark.ink);
    if (mark.density > 0)
        g_array_append_val(fronts, mark);
}

void fl_marks_add_stain(const FlWetShape *shape, const FlMovingEdge *edge,
                        const FlWetAround *around, const FlWetDials *dials, GArray *marks,
                        GArray *fronts)
{
    const FlRect rect = shape->rect;
    for (int y = 0; y < rect.height && edge->n > 0; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            if (around->touched[p] == 0 || edge->contour.nearest[p] < 0)
                continue;
            const FlEdgePoint *point = &edge->point[edge->contour.nearest[p]];
            const float inset = MIN(2.5f * shape->px, 0.45f * point->half_width);
            const float px = (float)x + shape->beside[0], py = (float)y + shape->beside[1];
            const float below = under(shape, point);
            const float depth = fl_wet_plane_at(edge->distance, rect, px, py) - inset;
            const float now = depth - below;
            const float reach = fabsf(point->u) + fabsf(point->v) + 2;
            const bool far = -now > reach && shape->distance_before[p] < inset - reach;
            if (now >= 0.5f || far)
                continue;
            float ground[2];
            fl_wet_ground(shape, px, py, ground);
            const Passing pixel = {.shape = shape,
                                   .point = point,
                                   .distance = edge->distance,
                                   .inset = inset,
                                   .x = px,
                                   .y = py,
                                   .before_x = px - ground[0],
                                   .before_y = py - ground[1],
                                   .touched = (float)around->touched[p] / 255};
            const int32_t at = (rect.y + y) * shape->page.width + rect.x + x;
            pass(&pixel, dials, at, now, marks);
            if (below > 0.5f)
                wet_below(&pixel, dials, at, depth, fronts);
        }
}

/** The share of an earlier front that stays where its edge goes back: below the shape as much as
 * the paper keeps of its paint; ahead of the shape a front would stand alone as an arc, and goes.
 */
static float stays(const FlWetShape *shape, const FlMovingEdge *edge, int x, int y)
{
    const FlRect rect = shape->rect;
    if (x < rect.x || y < rect.y || x >= rect.x + rect.width || y >= rect.y + rect.height)
        return 0;
    const size_t p = (size_t)(y - rect.y) * (size_t)rect.width + (size_t)(x - rect.x);
    if (edge->contour.nearest[p] < 0)
        return 1;
    const FlEdgePoint *point = &edge->point[edge->contour.nearest[p]];
    const float moved = sqrtf(point->u * point->u + point->v * point->v);
    const float gone = fl_ease(1, 1.5f, -edge->distance[p] / (moved + 24 * shape->px));
    const float below = fl_ease(-2 * shape->px, 2 * shape->px, shape->distance_before[p]);
    return (1 - gone) * (1 - recedes(shape, point) * (1 - below * MIN(point->kept, 1)));
}

void fl_marks_lose_fronts(const FlWetShape *shape, const FlMovingEdge *edge, const GArray *fronts,
                          GArray *marks)
{
    for (guint k = 0; k < fronts->len; k++) {
        const int32_t at = g_array_index(fronts, FlFrontMark, k).at;
        const int width = shape->page.width;
        const FlStainMark mark = {.at = at, .lost = 1 - stays(shape, edge, at % width, at / width)};
        if (mark.lost > 0)
            g_array_append_val(marks, mark);
    }
}
