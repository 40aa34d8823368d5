#include "lazy/fluid_planes.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include <math.h>
#include <string.h>

bool fl_fluid_planes_init(FlFluidPlanes *planes, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    float *all = fl_alloc(FL_FLUID_PLANES * pixels, sizeof *all, "a region's guides", error);
    *planes = (FlFluidPlanes){width, height, {NULL}};
    for (size_t k = 0; all && k < FL_FLUID_PLANES; k++)
        planes->plane[k] = all + k * pixels;
    return all != NULL;
}

void fl_fluid_planes_clear(FlFluidPlanes *planes)
{
    free(planes->plane[0]);
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

void fl_fluid_planes_halve(const FlFluidPlanes *fine, FlFluidPlanes *coarse)
{
#pragma omp parallel for schedule(static)
    for (int k = 0; k < FL_FLUID_PLANES; k++)
        halve(fine->plane[k], fine->width, fine->height, coarse->plane[k]);
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
    if (all)
        picture->pixel = all + FL_PATCH_RADIUS * pitch + FL_PATCH_RADIUS;
    return all != NULL;
}

void fl_fluid_picture_clear(FlFluidPicture *picture)
{
    if (picture->pixel)
        free(picture->pixel - FL_PATCH_RADIUS * picture->pitch - FL_PATCH_RADIUS);
    *picture = (FlFluidPicture){0};
}

/* What 1.0 is in a channel that has a plane. */
static void scales_of(const FlFluidWeights *weights, float scale[FL_FLUID_PLANE_WEIGHT])
{
    const float past = sqrtf(weights->past), alpha = sqrtf(3);
    const float of[] = {1, 1, 1, alpha, sqrtf(weights->edge), past, past, past, past * alpha};
    for (int k = 0; k < FL_FLUID_PLANE_WEIGHT; k++)
        scale[k] = of[k] * FL_FLUID_ONE;
}

static int channel_of(int plane)
{
    return plane < FL_FLUID_PLANE_PAST ? plane : plane - FL_FLUID_PLANE_PAST + FL_FLUID_PAST;
}

void fl_fluid_picture_pack(const FlFluidPlanes *planes, const FlFluidWeights *weights,
                           bool is_target, FlFluidPicture *picture)
{
    const int width = picture->width, height = picture->height;
    float scale[FL_FLUID_PLANE_WEIGHT];
    scales_of(weights, scale);
#pragma omp parallel for schedule(static)
    for (int y = -FL_PATCH_RADIUS; y < height + FL_PATCH_RADIUS; y++)
        for (int x = -FL_PATCH_RADIUS; x < width + FL_PATCH_RADIUS; x++) {
            FlFluidTexel *to = picture->pixel + y * picture->pitch + x;
            const size_t from =
                (size_t)CLAMP(y, 0, height - 1) * (size_t)width + (size_t)CLAMP(x, 0, width - 1);
            for (int k = 0; k < FL_FLUID_PLANE_WEIGHT; k++)
                to->c[channel_of(k)] = (int16_t)(planes->plane[k][from] * scale[k] + 0.5f);
            to->c[FL_FLUID_WEIGHT] =
                (int16_t)(is_target ? planes->plane[FL_FLUID_PLANE_WEIGHT][from] * 32767 + 0.5f
                                    : 0);
        }
}

bool fl_fluid_segments_init(FlFluidSegments *segments, const FlFluidPlanes *planes, GError **error)
{
    const uint32_t pixels = (uint32_t)planes->width * (uint32_t)planes->height;
    const float *edge = planes->plane[FL_FLUID_PLANE_EDGE];
    *segments = (FlFluidSegments){0};
    for (uint32_t p = 0; p < pixels; p++)
        if (edge[p] > FL_FLUID_LOWER)
            segments->n[edge[p] >= FL_FLUID_UPPER]++;
    for (int s = 0; s < 2; s++)
        if (!(segments->place[s] =
                  fl_alloc(segments->n[s], sizeof(uint32_t), "a region's segments", error)))
            return false;
    size_t n[2] = {0};
    for (uint32_t p = 0; p < pixels; p++)
        if (edge[p] > FL_FLUID_LOWER) {
            const int s = edge[p] >= FL_FLUID_UPPER;
            segments->place[s][n[s]++] = p;
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
