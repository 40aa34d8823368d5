#include "lazy/lazy_state.h"

#define SEGMENT_WEIGHT 100 // a patch of another segment is never taken

/* Planes from `first` on as an interleaved picture. */
static void interleave(const FlFluidPlanes *planes, int first, int channels, uint8_t *to)
{
    const size_t n = (size_t)planes->width * (size_t)planes->height;
    for (int c = 0; c < channels; c++)
        for (size_t p = 0; p < n; p++)
            to[p * (size_t)channels + (size_t)c] = fl_guide_byte(planes->plane[first + c][p]);
}

static bool add(const char *name, int first, int channels, float weight,
                const FlFluidPlanes *source, const FlFluidPlanes *target, FlGuidePairs *pairs,
                FlGuidePair **pair, GError **error)
{
    if (!fl_guide_pairs_add(pairs, name, channels, weight, false, pair, error))
        return false;
    if (*pair) {
        interleave(source, first, channels, (*pair)->source);
        interleave(target, first, channels, (*pair)->target);
    }
    return true;
}

/* Outside, border and interior as black, grey and white. */
static void fill_segments(const FlFluidPlanes *planes, uint8_t *to)
{
    const size_t n = (size_t)planes->width * (size_t)planes->height;
    const float *edge = planes->plane[FL_FLUID_PLANE_EDGE];
    for (size_t p = 0; p < n; p++)
        to[p] = edge[p] >= FL_FLUID_UPPER ? 255 : edge[p] > FL_FLUID_LOWER ? 128 : 0;
}

static void fill_paper(const FlFluidPlanes *planes, const uint8_t paper[3], uint8_t *rgb)
{
    const size_t n = (size_t)planes->width * (size_t)planes->height;
    for (size_t p = 0; p < n; p++)
        if (planes->plane[FL_FLUID_PLANE_PAST + 3][p] <= 0)
            for (size_t c = 0; c < 3; c++)
                rgb[3 * p + c] = paper[c];
}

static bool add_past(const FlFluidPlanes *source, const FlFluidPlanes *target, float weight,
                     const uint8_t paper[3], FlGuidePairs *pairs, GError **error)
{
    FlGuidePair *colour = NULL, *alpha = NULL;
    const float *counts = target->plane[FL_FLUID_PLANE_WEIGHT];
    if (!counts) // a first frame
        return true;
    if (!add("past", FL_FLUID_PLANE_PAST, 3, weight, source, target, pairs, &colour, error) ||
        !add("past-alpha", FL_FLUID_PLANE_PAST + 3, 1, 3 * weight, source, target, pairs, &alpha,
             error))
        return false;
    if (colour && alpha) {
        fill_paper(target, paper, colour->target);
        if (!fl_guide_fill(colour->target, 3, counts, target->width, target->height) ||
            !fl_guide_fill(alpha->target, 1, counts, target->width, target->height))
            fl_guide_pairs_drop(pairs, 2); // all of it is new
    }
    return true;
}

/* Divides colours by their alpha. */
static void straighten(uint8_t *rgba, size_t n, const uint8_t paper[3])
{
    for (size_t p = 0; p < n; p++, rgba += 4)
        for (size_t c = 0; c < 3; c++)
            rgba[c] =
                rgba[3] ? (uint8_t)MIN((rgba[c] * 255 + rgba[3] / 2) / rgba[3], 255) : paper[c];
}

bool fl_lazy_pairs(const FlFluidPlanes *source, const FlFluidPlanes *target,
                   const FlFluidWeights *weights, const uint8_t paper[3], bool multiplied,
                   FlGuidePairs *pairs, GError **error)
{
    FlGuidePair *pair = NULL;
    if (!fl_guide_pairs_init(pairs, (int[]){source->width, source->height},
                             (int[]){target->width, target->height}, 4, 1, error))
        return false;
    interleave(source, FL_FLUID_PLANE_COLOUR, 4, pairs->style);
    if (multiplied)
        straighten(pairs->style, (size_t)source->width * (size_t)source->height, paper);
    if (!add("alpha", FL_FLUID_PLANE_EDGE, 1, weights->edge, source, target, pairs, &pair, error) ||
        !fl_guide_pairs_add(pairs, "segment", 1, SEGMENT_WEIGHT, false, &pair, error))
        return false;
    fill_segments(source, pair->source);
    fill_segments(target, pair->target);
    return add_past(source, target, weights->past, paper, pairs, error);
}
