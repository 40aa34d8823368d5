#include "lazy/fluid_exemplar.h"

#include "base/alloc.h"
#include <string.h>

static bool settle(const float *alpha, float *filled, int width, int height, int x, int y)
{
    const size_t p = (size_t)y * (size_t)width + (size_t)x;
    const bool outermost = x == 0 || y == 0 || x == width - 1 || y == height - 1;
    float way = outermost ? 0 : 1;
    if (!outermost) {
        way = MIN(filled[p - 1], filled[p + 1]);
        way = MIN(way, MIN(filled[p - (size_t)width], filled[p + (size_t)width]));
    }
    const float level = MAX(alpha[p], way);
    const bool changes = level < filled[p];
    filled[p] = MIN(level, filled[p]);
    return changes;
}

/* Sweeps down and up until all pixels are settled; the result does not depend on the order. */
static void fill_holes(const float *alpha, int width, int height, float *filled)
{
    for (bool changes = true; changes;) {
        changes = false;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++)
                changes |= settle(alpha, filled, width, height, x, y);
        for (int y = height - 1; y >= 0; y--)
            for (int x = width - 1; x >= 0; x--)
                changes |= settle(alpha, filled, width, height, x, y);
    }
}

/*
 * Raises alpha, width * height of 0 … 1, until no pixel is lower than the lowest way out of the
 * frame from it, and then so far that the mean of what is at least half covered is one. Holes and
 * translucent places are texture of the interior; blurred alpha alone, by which [L15 §4.2] tells
 * interior from boundary, would show them along contours only.
 */
static bool fluid_shape(float *alpha, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    g_autofree float *filled = fl_alloc(pixels, sizeof *filled, "an exemplar", error);
    double sum = 0, n = 0;
    if (!filled)
        return false;
    for (size_t p = 0; p < pixels; p++)
        filled[p] = 1;
    fill_holes(alpha, width, height, filled);
    for (size_t p = 0; p < pixels; p++)
        if (filled[p] >= .5f)
            sum += filled[p], n++;
    const float gain = n > 0 ? (float)(n / sum) : 1;
    for (size_t p = 0; p < pixels; p++)
        alpha[p] = MIN(filled[p] * gain, 1);
    return true;
}

bool fl_fluid_splines_init(FlExemplarLevel *level, int width, int height, GError **error)
{
    *level = (FlExemplarLevel){.width = width, .height = height, .n_frames = 1, .window = 1};
    level->pitch = (size_t)width + 2 * FL_PAD;
    level->frame_pixels = level->pitch * ((size_t)height + 2 * FL_PAD);
    level->colour = fl_alloc(level->frame_pixels, sizeof *level->colour, "an exemplar", error);
    return level->colour != NULL;
}

void fl_fluid_splines_fill(const FlExemplarLevel *level, int c, float *plane)
{
    fl_spline_prefilter_channel(plane, c, level->width, level->height,
                                level->colour + FL_PAD * level->pitch + FL_PAD, (int)level->pitch);
}

static void level_clear(FlFluidLevel *level)
{
    fl_fluid_picture_clear(&level->picture);
    fl_fluid_segments_clear(&level->segments);
    free(level->voted.colour);
    *level = (FlFluidLevel){0};
}

void fl_fluid_exemplar_clear(FlFluidExemplar *fluid)
{
    for (int l = 0; l < FL_MAX_LEVELS; l++)
        level_clear(&fluid->level[l]);
    *fluid = (FlFluidExemplar){0};
}

/* The mask without its margin of bare paper, which would become bare fluid. */
static float alpha_of(const FlExemplar *exemplar, size_t p)
{
    const float inside = CLAMP(exemplar->distance[p] + 0.5f, 0, 1);
    const float covered = (float)exemplar->mask[p] / 255;
    return exemplar->margin_px > 0 && !exemplar->cut_out ? MIN(covered, inside) : covered;
}

/* Colour and alpha of a frame into four planes; for a cut-out without its paper, so that invisible
 * colours do not affect votes and distances. */
static void fill_colour(const FlExemplar *exemplar, int t, float *const plane[4])
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const size_t pixels = (size_t)full->width * (size_t)full->height;
    const float paper[] = {(float)exemplar->paper[0] / 255, (float)exemplar->paper[1] / 255,
                           (float)exemplar->paper[2] / 255};
    for (int y = 0; y < full->height; y++)
        for (int x = 0; x < full->width; x++) {
            const size_t p = (size_t)y * (size_t)full->width + (size_t)x;
            const FlTexel *from = fl_exemplar_at(full, x, y, t);
            const float alpha = alpha_of(exemplar, (size_t)t * pixels + p);
            const float bare = exemplar->cut_out ? 1 - alpha : 0;
            for (int c = 0; c < 3; c++)
                plane[c][p] = MAX((float)from->c[FL_CH_R + c] / FL_TEXEL_ONE - bare * paper[c], 0);
            plane[3][p] = alpha;
        }
}

bool fl_fluid_exemplar_planes(const FlExemplar *exemplar, int frame, int before, float sigma_px,
                              FlFluidPlanes *planes, GError **error)
{
    const int width = exemplar->level[0].width, height = exemplar->level[0].height;
    const size_t bytes = (size_t)width * (size_t)height * sizeof(float);
    if (!fl_fluid_planes_init(planes, width, height, 0, FL_FLUID_PLANE_WEIGHT, error))
        return false;
    fill_colour(exemplar, frame, planes->plane + FL_FLUID_PLANE_COLOUR);
    fill_colour(exemplar, before, planes->plane + FL_FLUID_PLANE_PAST);
    memcpy(planes->plane[FL_FLUID_PLANE_EDGE], planes->plane[3], bytes);
    return (!exemplar->cut_out ||
            fluid_shape(planes->plane[FL_FLUID_PLANE_EDGE], width, height, error)) &&
           fl_fluid_planes_blur(planes, sigma_px, error);
}

#define MIN_SEGMENT 25 // pixels: a patch of them, else segments are not separate

/* Segments are separate on a level where both have enough pixels. */
static bool pack_segments(FlFluidLevel *level, const FlFluidPlanes *planes, GError **error)
{
    return fl_fluid_segments_init(&level->segments, planes, error) &&
           ((level->segments.n[0] >= MIN_SEGMENT && level->segments.n[1] >= MIN_SEGMENT) ||
            fl_fluid_segments_merge(&level->segments, error));
}

static bool pack_level(FlFluidLevel *level, FlFluidPlanes *planes, const FlFluidWeights *weights,
                       GError **error)
{
    if (!fl_fluid_picture_init(&level->picture, planes->width, planes->height, error) ||
        !pack_segments(level, planes, error))
        return false;
    fl_fluid_picture_pack(planes, weights, &level->picture);
    return true;
}

bool fl_fluid_exemplar_pack(FlFluidExemplar *fluid, const FlExemplar *exemplar, int frame,
                            int before, int n_levels, float sigma_px, const FlFluidWeights *weights,
                            GError **error)
{
    if (fluid->n_levels >= n_levels && fluid->frame == frame && fluid->before == before)
        return true;
    fl_fluid_exemplar_clear(fluid);
    g_auto(FlFluidPlanes) fine = {0};
    if (!fl_fluid_exemplar_planes(exemplar, frame, before, sigma_px, &fine, error))
        return false;
    for (int l = 0; l < n_levels; l++) {
        FlFluidPlanes coarse = {0};
        if (!pack_level(&fluid->level[l], &fine, weights, error) ||
            !fl_fluid_planes_halve(&fine, &coarse, error))
            return false;
        const bool done =
            fl_fluid_splines_init(&fluid->level[l].voted, fine.width, fine.height, error);
        for (int k = 0; k < 4 && done; k++)
            fl_fluid_splines_fill(&fluid->level[l].voted, k, fine.plane[k]);
        fl_fluid_planes_clear(&fine);
        fine = coarse;
        if (!done)
            return false;
    }
    fluid->n_levels = n_levels, fluid->frame = frame, fluid->before = before;
    return true;
}
