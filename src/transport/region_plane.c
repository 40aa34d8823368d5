#include "transport/region_plane.h"

#include "base/schedule.h"
#include <math.h>

#define OUTSIDE (-1000.f) // a depth

/* ---- the place of the region -------------------------------------------------------------------
 */

static int grid_below(float px)
{
    return (int)floorf(px / FL_REGION_PLANE_GRID) * FL_REGION_PLANE_GRID;
}

/* From the frame to the material, px of the drawing. */
static void to_material(const FlRigid *lies, float x, float y, float at[2])
{
    const float c = (float)lies->cosine, s = (float)lies->sine;
    const float dx = x - (float)lies->x, dy = y - (float)lies->y;
    at[0] = (float)lies->u + c * dx - s * dy, at[1] = (float)lies->v + s * dx + c * dy;
}

/* A direction of the material in the frame. */
static void from_material(const FlRigid *lies, float u, float v, float to[2])
{
    const float c = (float)lies->cosine, s = (float)lies->sine;
    to[0] = c * u + s * v, to[1] = c * v - s * u;
}

static FlRigid lies_on_material(const FlMaterialLayers *layers, const FlGuides *guides)
{
    FlFit sums = {0};
    fl_material_add_fit(&layers->old, &layers->share, 0, guides, &sums);
    if (layers->share.shift)
        fl_material_add_fit(&layers->fresh, &layers->share, 1, guides, &sums);
    return fl_material_rigid(&sums);
}

static FlRect box_around(const FlRigid *lies, FlRect rect, const FlGuides *guides, float scale,
                         float room)
{
    float low[2] = {HUGE_VALF, HUGE_VALF}, high[2] = {-HUGE_VALF, -HUGE_VALF}, at[2];
    for (int y = rect.y; y < rect.y + rect.height; y++)
        for (int x = rect.x; x < rect.x + rect.width; x++) {
            if (!guides->mask[(size_t)y * (size_t)guides->width + (size_t)x])
                continue;
            to_material(lies, (float)x, (float)y, at);
            for (int c = 0; c < 2; c++)
                low[c] = fminf(low[c], at[c]), high[c] = fmaxf(high[c], at[c]);
        }
    int corner[2], end[2];
    for (int c = 0; c < 2; c++) {
        corner[c] = grid_below(low[c] / scale - room);
        end[c] = grid_below(high[c] / scale + room) + FL_REGION_PLANE_GRID;
    }
    return fl_rect_between(corner[0], corner[1], end[0], end[1]);
}

FlRegionPlane fl_region_plane(const FlMaterialLayers *layers, const FlGuides *guides, float scale,
                              int room)
{
    const FlRigid lies = lies_on_material(layers, guides);
    return (FlRegionPlane){lies, scale,
                           box_around(&lies, layers->old.rect, guides, scale, (float)room)};
}

bool fl_region_plane_same(const FlRegionPlane *a, const FlRegionPlane *b)
{
    const FlRigid *p = &a->lies, *q = &b->lies;
    return a->box.x == b->box.x && a->box.y == b->box.y && a->box.width == b->box.width &&
           a->box.height == b->box.height && p->cosine == q->cosine && p->sine == q->sine &&
           p->x == q->x && p->y == q->y && p->u == q->u && p->v == q->v;
}

/* ---- places and directions --------------------------------------------------------------------
 */

void fl_region_plane_to_frame(const FlRegionPlane *plane, int x, int y, float at[2])
{
    const FlRigid *lies = &plane->lies;
    from_material(lies, ((float)(x + plane->box.x) + 0.5f) * plane->scale - 0.5f - (float)lies->u,
                  ((float)(y + plane->box.y) + 0.5f) * plane->scale - 0.5f - (float)lies->v, at);
    at[0] += (float)lies->x, at[1] += (float)lies->y;
}

void fl_region_plane_from_frame(const FlRegionPlane *plane, float x, float y, float at[2])
{
    to_material(&plane->lies, x, y, at);
    at[0] = (at[0] + 0.5f) / plane->scale - 0.5f - (float)plane->box.x;
    at[1] = (at[1] + 0.5f) / plane->scale - 0.5f - (float)plane->box.y;
}

float fl_region_plane_depth(const FlRegionPlane *plane, const FlGuides *guides, FlRect rect,
                            float x, float y)
{
    if (x <= (float)rect.x - 1 || y <= (float)rect.y - 1 || x >= (float)(rect.x + rect.width) ||
        y >= (float)(rect.y + rect.height))
        return OUTSIDE;
    const FlFour at = fl_four_around(x, y, guides->width, guides->height);
    return fl_mean_of_four(guides->distance, 1, &at) / plane->scale;
}

void fl_region_plane_turn(const FlRegionPlane *plane, const float frame[2], float of_plane[2])
{
    const float c = (float)plane->lies.cosine, s = (float)plane->lies.sine;
    of_plane[0] = (c * frame[0] - s * frame[1]) / plane->scale;
    of_plane[1] = (s * frame[0] + c * frame[1]) / plane->scale;
}

void fl_region_plane_velocity(const FlRegionPlane *plane, const float *from, FlRect rect,
                              float *velocity)
{
    const FlRect b = plane->box;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(fl_rect_pixels(rect)))
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            float at[2];
            fl_region_plane_from_frame(plane, (float)(x + rect.x), (float)(y + rect.y), at);
            const FlFour four = fl_four_around(at[0], at[1], b.width, b.height);
            from_material(&plane->lies, plane->scale * fl_mean_of_four(from, 2, &four),
                          plane->scale * fl_mean_of_four(from + 1, 2, &four),
                          velocity + 2 * ((size_t)y * (size_t)rect.width + (size_t)x));
        }
}

/* ---- samples -----------------------------------------------------------------------------------
 */

FlFour fl_four_around(float x, float y, int width, int height)
{
    x = fminf(fmaxf(x, 0), (float)(width - 1)), y = fminf(fmaxf(y, 0), (float)(height - 1));
    const int x0 = (int)x, y0 = (int)y, x1 = MIN(x0 + 1, width - 1), y1 = MIN(y0 + 1, height - 1);
    const float fx = x - (float)x0, fy = y - (float)y0;
    const size_t up = (size_t)y0 * (size_t)width, down = (size_t)y1 * (size_t)width;
    return (FlFour){{up + (size_t)x0, up + (size_t)x1, down + (size_t)x0, down + (size_t)x1},
                    {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy}};
}

float fl_mean_of_four(const float *plane, size_t step, const FlFour *four)
{
    float sum = 0;
    for (int k = 0; k < 4; k++)
        sum += four->share[k] * plane[step * four->p[k]];
    return sum;
}
