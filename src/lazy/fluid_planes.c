#include "lazy/fluid_planes.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include <math.h>

bool fl_fluid_planes_init(FlFluidPlanes *planes, int width, int height, int first, int end,
                          GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *planes = (FlFluidPlanes){.width = width, .height = height};
    planes->all =
        fl_alloc((size_t)(end - first) * pixels, sizeof(float), "a region's guides", error);
    for (int k = first; planes->all && k < end; k++)
        planes->plane[k] = planes->all + (size_t)(k - first) * pixels;
    return planes->all != NULL;
}

void fl_fluid_planes_clear(FlFluidPlanes *planes)
{
    free(planes->all);
    *planes = (FlFluidPlanes){0};
}

static void halve(const float *fine, int width, int height, float *coarse)
{
    const int half_width = (width + 1) / 2, half_height = (height + 1) / 2;
    for (int y = 0; y < half_height; y++) {
        const float *a = fine + (size_t)(2 * y) * (size_t)width;
        const float *b = fine + (size_t)MIN(2 * y + 1, height - 1) * (size_t)width;
        for (int x = 0; x < half_width; x++) {
            const int left = 2 * x, right = MIN(2 * x + 1, width - 1);
            coarse[(size_t)y * (size_t)half_width + (size_t)x] =
                (a[left] + a[right] + b[left] + b[right]) / 4;
        }
    }
}

bool fl_fluid_planes_halve(const FlFluidPlanes *fine, FlFluidPlanes *coarse, GError **error)
{
    int first = 0, end = FL_FLUID_PLANES;
    while (first < end && !fine->plane[first])
        first++;
    while (end > first && !fine->plane[end - 1])
        end--;
    if (!fl_fluid_planes_init(coarse, (fine->width + 1) / 2, (fine->height + 1) / 2, first, end,
                              error))
        return false;
#pragma omp parallel for schedule(static)
    for (int k = first; k < end; k++)
        halve(fine->plane[k], fine->width, fine->height, coarse->plane[k]);
    return true;
}

bool fl_fluid_planes_blur(FlFluidPlanes *planes, float sigma_px, GError **error)
{
    return fl_blur(planes->plane[FL_FLUID_PLANE_EDGE], planes->width, planes->height, sigma_px,
                   error);
}

bool fl_fluid_picture_init(FlFluidPicture *picture, int width, int height, GError **error)
{
    const size_t pitch = (size_t)width + 2 * FL_PATCH_RADIUS;
    const size_t n = pitch * ((size_t)height + 2 * FL_PATCH_RADIUS);
    FlFluidTexel *all = fl_alloc(n, sizeof *all, "a region's guides", error);
    *picture = (FlFluidPicture){width, height, (ptrdiff_t)pitch, NULL};
    if (!all)
        return false;
    // channels without a plane stay 0
    picture->pixel = all + FL_PATCH_RADIUS * pitch + FL_PATCH_RADIUS;
    return true;
}

void fl_fluid_picture_clear(FlFluidPicture *picture)
{
    if (picture->pixel)
        free(picture->pixel - FL_PATCH_RADIUS * picture->pitch - FL_PATCH_RADIUS);
    *picture = (FlFluidPicture){0};
}

/* The integer that stands for 1.0, per plane. */
static void scales_of(const FlFluidWeights *weights, float scale[FL_FLUID_PLANES])
{
    const float past = sqrtf(weights->past), alpha = sqrtf(3);
    const float of[] = {1, 1, 1, alpha, sqrtf(weights->edge), past, past, past, past * alpha};
    for (int k = 0; k < FL_FLUID_PLANE_WEIGHT; k++)
        scale[k] = of[k] * FL_FLUID_ONE;
    scale[FL_FLUID_PLANE_WEIGHT] = INT16_MAX;
}

static int channel_of(int plane)
{
    return plane == FL_FLUID_PLANE_WEIGHT ? FL_FLUID_WEIGHT
           : plane < FL_FLUID_PLANE_PAST  ? plane
                                          : plane - FL_FLUID_PLANE_PAST + FL_FLUID_PAST;
}

/* Packs row y of `n` values a pixel as channels from `first` on, and what repeats it around. */
static void pack_row(const float *values, int n, const float *scale, int first, int y,
                     const FlFluidPicture *picture)
{
    const int r = FL_PATCH_RADIUS, width = picture->width, last = picture->height - 1;
    for (int v = y == 0 ? -r : y; v <= (y == last ? last + r : y); v++)
        for (int x = -r; x < width + r; x++) {
            const float *from = values + (size_t)n * (size_t)CLAMP(x, 0, width - 1);
            int16_t *to = picture->pixel[v * picture->pitch + x].c + first;
            for (int c = 0; c < n; c++)
                to[c] = (int16_t)(from[c] * scale[c] + 0.5f);
        }
}

void fl_fluid_picture_pack(const FlFluidPlanes *planes, const FlFluidWeights *weights,
                           const FlFluidPicture *picture)
{
    float scale[FL_FLUID_PLANES];
    scales_of(weights, scale);
#pragma omp parallel for schedule(static)
    for (int y = 0; y < picture->height; y++)
        for (int k = 0; k < FL_FLUID_PLANES; k++)
            if (planes->plane[k])
                pack_row(planes->plane[k] + (size_t)y * (size_t)planes->width, 1, &scale[k],
                         channel_of(k), y, picture);
}

void fl_fluid_picture_pack_row(const float *rgba, int y, const FlFluidPicture *picture)
{
    float scale[FL_FLUID_PLANES];
    scales_of(&(FlFluidWeights){0}, scale);
    pack_row(rgba, 4, scale, FL_FLUID_R, y, picture);
}

#define REACHES 0.75f // least blurred alpha in a patch of the interior

enum { BORDER, INTERIOR, NO_FLUID };

/* The segment of a pixel. A patch that reaches over the contour is none of the interior, where it
 * would leave spots of the edge. */
static uint8_t segment_of(const FlFluidPlanes *planes, int x, int y)
{
    const int r = FL_PATCH_RADIUS, width = planes->width, height = planes->height;
    const float *edge = planes->plane[FL_FLUID_PLANE_EDGE];
    if (!(edge[y * width + x] >= FL_FLUID_UPPER))
        return edge[y * width + x] > FL_FLUID_LOWER ? BORDER : NO_FLUID;
    for (int v = MAX(y - r, 0); v <= MIN(y + r, height - 1); v++)
        for (int u = MAX(x - r, 0); u <= MIN(x + r, width - 1); u++)
            if (!(edge[v * width + u] >= REACHES))
                return BORDER;
    return INTERIOR;
}

bool fl_fluid_segments_init(FlFluidSegments *segments, const FlFluidPlanes *planes, GError **error)
{
    const int width = planes->width, height = planes->height;
    const uint32_t pixels = (uint32_t)width * (uint32_t)height;
    g_autofree uint8_t *of = fl_alloc(pixels, 1, "a region's segments", error);
    *segments = (FlFluidSegments){0};
    if (!of)
        return false;
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            of[y * width + x] = segment_of(planes, x, y);
    for (int s = BORDER; s <= INTERIOR; s++) {
        for (uint32_t p = 0; p < pixels; p++)
            segments->n[s] += of[p] == s;
        if (!(segments->place[s] =
                  fl_alloc(segments->n[s], sizeof(uint32_t), "a region's segments", error)))
            return false;
        for (uint32_t p = 0, k = 0; k < segments->n[s]; p++)
            if (of[p] == s)
                segments->place[s][k++] = p;
    }
    return true;
}

void fl_fluid_segments_clear(FlFluidSegments *segments)
{
    free(segments->place[0]);
    free(segments->place[1]);
    *segments = (FlFluidSegments){0};
}

bool fl_fluid_segments_merge(FlFluidSegments *segments, GError **error)
{
    const size_t n = segments->n[0] + segments->n[1];
    uint32_t *all = fl_alloc(n, sizeof *all, "a region's segments", error);
    if (!all)
        return false;
    for (size_t k = 0, i = 0, j = 0; k < n; k++)
        all[k] = j == segments->n[1] ||
                         (i < segments->n[0] && segments->place[0][i] < segments->place[1][j])
                     ? segments->place[0][i++]
                     : segments->place[1][j++];
    free(segments->place[0]);
    segments->place[0] = all, segments->n[0] = n, segments->n[1] = 0;
    return true;
}
