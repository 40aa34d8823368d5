#include "guides/rim.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/windows.h"
#include "guides/distance.h"
#include "guides/local_width.h"
#include <string.h>

#define MARGIN_PX 6        // around a shape; its patches reach less far out
#define NO_RIM 0.33f       // half width from which on there is a rim beside paper, share of border
#define RIM_FULL 0.2f      // width of a rim from which on it is a whole one, share of border
#define DETAIL_WIDE 1.5f   // half width from which on a detail has a whole rim, share of border
#define DETAIL_NO_RIM 0.6f // up to this share of that its contour is crisp

/** A rim: how wide it is, and how much of one is there at the contour. */
typedef struct Rim {
    float width, amount;
} Rim;

/** Of a detail that lies over something else: u is its half width, of a border. Eyes stay round. */
static Rim detail_rim(float u)
{
    const float v = MIN(u / DETAIL_WIDE, 1.0f);
    return (Rim){v * v, fl_smooth((v - DETAIL_NO_RIM) / (1 - DETAIL_NO_RIM))};
}

/**
 * Beside paper. A soft rim looks like less paint, and a taper must not seem to get thinner before
 * it gets wider: with a straight line what is seen never falls as the width rises.
 */
static Rim taper_rim(float u)
{
    const float width = CLAMP((u - NO_RIM) / (1.0f - NO_RIM), 0.0f, 1.0f);
    return (Rim){width, fl_smooth(width / RIM_FULL)};
}

/** others: how much of what is beyond is other shapes', 0 … 1. */
static Rim rim_of(float u, float others)
{
    const Rim taper = taper_rim(u), detail = detail_rim(u);
    return (Rim){taper.width + (detail.width - taper.width) * others,
                 taper.amount + (detail.amount - taper.amount) * others};
}

/** As if the rim were as wide as the border, and as if a pixel without a rim lay amid the shape.
 * u: below DETAIL_WIDE. */
static float depth_of(float distance, float border_px, float u, float others)
{
    if (u >= 1.0f && others == 0.0f)
        return distance;
    const Rim rim = rim_of(u, others);
    const float rim_px = MAX(rim.width * border_px, 0.5f);
    const float own = distance > 0.0f ? distance * border_px / rim_px : distance;
    const float depth = border_px * (1.0f - rim.amount) + rim.amount * own;
    return MAX(distance, MIN(depth, border_px));
}

/** The data of a part of the frame. */
typedef struct Part {
    FlRect box;
    float *distance;      // to the contour of all that are together
    uint16_t *half_width; // of them
    uint8_t *coverage, *seen, *shown;
    int16_t *plane;
    uint32_t *free, *taken; // sums: of what is not theirs, and what of it is others'
} Part;

static void part_clear(Part *part)
{
    free(part->distance);
    free(part->half_width);
    free(part->coverage);
    free(part->seen);
    free(part->shown);
    free(part->plane);
    free(part->free);
    free(part->taken);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Part, part_clear)

static int surround_radius(float border_px)
{
    return MAX((int)(border_px + 0.5f), 1);
}

/** The box of all pixels that a half width depends on: a disc that holds the pixel, and the disc's
 * contour. Without shapes like this one, both lie inside the shape, and the surroundings of the
 * last pixels reach farther. */
static FlRect part_box(const FlRimShape *shape, float border_px)
{
    const int disc = 2 * (int)(DETAIL_WIDE * border_px + 1.0f) + MARGIN_PX;
    const int own = FL_WIDTH_OUTSIDE_PX + surround_radius(border_px);
    const int px = shape->together ? disc : MIN(own, disc);
    const FlRect box = fl_rect_of(shape->mask, shape->width, shape->height);
    return box.width > 0 ? fl_rect_grown(box, px, (FlRect){0, 0, shape->width, shape->height})
                         : box;
}

static bool measure(Part *part, const FlRimShape *shape, float border_px, bool *narrow,
                    GError **error)
{
    const FlRect frame = {0, 0, shape->width, shape->height}, box = part->box;
    const size_t n = fl_rect_pixels(box);
    if (!(part->distance = fl_alloc_unset(n, sizeof *part->distance, "a guide", error)) ||
        !(part->half_width = fl_alloc_unset(n, sizeof *part->half_width, "a guide", error)) ||
        !(part->coverage = fl_alloc_unset(n, 1, "a guide", error)))
        return false;
    fl_rect_copy(shape->together ? shape->together : shape->mask, frame, part->coverage, box, 1);
    if (!shape->together)
        fl_rect_copy(shape->distance, frame, part->distance, box, sizeof *part->distance);
    else if (!fl_distance(part->coverage, box.width, box.height, part->distance, error))
        return false;
    if (shape->seen && !(part->seen = fl_alloc_unset(n, 1, "a guide", error)))
        return false;
    if (shape->seen)
        fl_rect_copy(shape->seen, frame, part->seen, box, 1);
    return fl_local_width(part->distance, part->seen, box.width, box.height,
                          DETAIL_WIDE * border_px, part->half_width, narrow, error);
}

/** Sums what is not theirs, and what of it others have, over squares of the border's radius. */
static bool measure_surround(Part *part, const FlRimShape *shape, float border_px, GError **error)
{
    const size_t n = fl_rect_pixels(part->box);
    const FlRect own = {0, 0, part->box.width, part->box.height};
    const int radius = surround_radius(border_px);
    if (!(part->shown = fl_alloc_unset(n, 1, "a guide", error)) ||
        !(part->plane = fl_alloc_unset(n, sizeof *part->plane, "a guide", error)) ||
        !(part->free = fl_alloc_unset(n, sizeof *part->free, "a guide", error)) ||
        !(part->taken = fl_alloc_unset(n, sizeof *part->taken, "a guide", error)))
        return false;
    fl_rect_copy(shape->shown, (FlRect){0, 0, shape->width, shape->height}, part->shown, part->box,
                 1);
    for (size_t p = 0; p < n; p++)
        part->plane[p] = (int16_t)(255 - part->coverage[p]);
    fl_window_sums(part->plane, own, radius, part->free);
    for (size_t p = 0; p < n; p++)
        part->plane[p] = (int16_t)((255 - part->coverage[p]) * part->shown[p] / 255);
    fl_window_sums(part->plane, own, radius, part->taken);
    return true;
}

static float others_at(const Part *part, size_t p)
{
    return part->taken && part->free[p] ? (float)part->taken[p] / (float)part->free[p] : 0.0f;
}

static void write_part(const Part *part, int width, float border_px, float *depth)
{
    const float border = (float)fl_width_cap(DETAIL_WIDE * border_px) / DETAIL_WIDE;
    for (int y = 0; y < part->box.height; y++) {
        float *row = depth + (size_t)(part->box.y + y) * (size_t)width + part->box.x;
        const size_t p = (size_t)y * (size_t)part->box.width;
        for (int x = 0; x < part->box.width; x++) {
            const size_t i = p + (size_t)x;
            const float u = part->half_width[i] ? (float)part->half_width[i] / border : DETAIL_WIDE;
            row[x] = u < DETAIL_WIDE ? depth_of(part->distance[i], border_px, u, others_at(part, i))
                                     : part->distance[i];
        }
    }
}

bool fl_rim_depth(const FlRimShape *shape, float border_px, float *depth, GError **error)
{
    const size_t n = (size_t)shape->width * (size_t)shape->height;
    g_auto(Part) part = {.box = part_box(shape, border_px)};
    bool narrow;
    memcpy(depth, shape->distance, n * sizeof *depth);
    if (part.box.width == 0)
        return true;
    if (!measure(&part, shape, border_px, &narrow, error) ||
        (narrow && shape->shown && !measure_surround(&part, shape, border_px, error)))
        return false;
    if (narrow)
        write_part(&part, shape->width, border_px, depth);
    else
        fl_rect_copy(part.distance, part.box, depth, (FlRect){0, 0, shape->width, shape->height},
                     sizeof *depth);
    return true;
}
