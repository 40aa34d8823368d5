#include "wet/marks.h"

#include "guides/guides.h"
#include "wet/curves.h"
#include <math.h>

/** A pixel that paint may have left, in the time since the frame before. */
typedef struct Passing {
    const FlWetShape *shape;
    const FlEdgePoint *point; // the nearest of the contour
    const float *distance;    // of the shape as it is now
    float inset;              // paint ends so far inside its shape, cells
    float x, y;
} Passing;

#define MOST_STEPS 12

/** The depth of the pixel below the painted edge at a time from 0, the frame before, to 1. */
static float depth_at(const Passing *pixel, float time)
{
    const FlWetShape *shape = pixel->shape;
    const bool before = time <= 0;
    const float left = before ? 0 : 1 - time;
    const float x = before ? pixel->x - shape->ground_x : pixel->x + left * pixel->point->u;
    const float y = before ? pixel->y - shape->ground_y : pixel->y + left * pixel->point->v;
    const FlRect rect = shape->rect;
    if (x < 0 || y < 0 || x > (float)rect.width - 1 || y > (float)rect.height - 1)
        return -1e6f;
    return fl_wet_plane_at(before ? shape->distance_before : pixel->distance, rect, x, y) -
           pixel->inset;
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
        if (depth >= cover.most || (k == 0 && depth > 0))
            cover.most = MAX(depth, cover.most), cover.when = (float)k / (float)steps;
        later = depth;
    }
    cover.last = MAX(cover.last, 0);
    return cover;
}

static float cover_of(float depth)
{
    return CLAMP(depth + 0.5f, 0, 1);
}

/** The share of its paint that the paper keeps: less of thin and fast strokes, 0 of shapes that
 * vanish without moving. */
static float kept_of(const Passing *pixel, float moved, float ahead)
{
    const FlWetShape *shape = pixel->shape;
    const float px = shape->px, width = MAX(pixel->point->half_width, 2 * px);
    const float speed = moved / shape->frames;
    const float contact = 1 - fl_fall(MIN(6, 2 * width / MAX(speed, px)) / 1.5f);
    const float rested = 0.8f + 0.4f * fl_bell(pixel->point->speed_before / px);
    return fl_bell(speed / (2.2f * width)) * (1 - fl_ease(1.3f, 2, ahead / (moved + 3 * px))) *
           contact * rested;
}

/** The paint that a pixel had: its own texture, but for the rim, which would draw an arc in each
 * frame; there the paint further inside. */
static void find_ink(const Passing *pixel, const Cover *cover, float ink[3])
{
    const FlWetShape *shape = pixel->shape;
    const FlEdgePoint *point = pixel->point;
    const float x = pixel->x - shape->ground_x - cover->when * point->u;
    const float y = pixel->y - shape->ground_y - cover->when * point->v;
    float own[3];
    const bool known = fl_wet_ink_at(shape, x, y, own);
    const float weight = known ? 0.45f * fl_ease(2 * shape->px, 12 * shape->px, cover->most) : 0;
    for (int c = 0; c < 3; c++)
        ink[c] = point->ink[c] + weight * (own[c] - point->ink[c]);
}

static void pass(const Passing *pixel, const FlWetDials *dials, int32_t at, float now,
                 GArray *marks)
{
    const FlWetShape *shape = pixel->shape;
    const FlEdgePoint *point = pixel->point;
    const float moved = sqrtf(point->u * point->u + point->v * point->v);
    const Cover cover = cover_in_time(pixel, moved);
    const float lost = cover_of(cover.most) - cover_of(now);
    if (lost <= 0.02f)
        return;
    FlStainMark mark = {.at = at, .lost = lost, .age = shape->frames * (1 - cover.last)};
    mark.charge = dials->stain * (1 - cover_of(now)) * kept_of(pixel, moved, MAX(-now, 0));
    find_ink(pixel, &cover, mark.ink);
    g_array_append_val(marks, mark);
}

void fl_marks_add_stain(const FlWetShape *shape, const FlMovingEdge *edge,
                        const FlWetAround *around, const FlWetDials *dials, GArray *marks)
{
    const FlRect rect = shape->rect;
    for (int y = 0; y < rect.height && edge->n > 0; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            if (!(around->touches[p] & 2) || edge->nearest[p] < 0)
                continue;
            const FlEdgePoint *point = &edge->point[edge->nearest[p]];
            const float inset = MIN(2.5f * shape->px, 0.45f * point->half_width);
            const float now = edge->distance[p] - inset;
            const float reach = fabsf(point->u) + fabsf(point->v) + 2;
            const bool far = -now > reach && shape->distance_before[p] < inset - reach;
            if (now >= 0.5f || far)
                continue;
            const Passing pixel = {shape, point, edge->distance, inset, (float)x, (float)y};
            pass(&pixel, dials, (rect.y + y) * shape->page.width + rect.x + x, now, marks);
        }
}
