#include "base/alloc.h"
#include "base/row_kernels.h"
#include "guides/gauss.h"
#include "guides/guides.h"
#include <math.h>

/** Blurs one row of coverage along x into dst; padded: scratch, width + 2 * radius. */
static void blur_row(const uint8_t *row, int width, const float *weight, int radius, float *padded,
                     float *dst)
{
    for (int x = -radius; x < width + radius; x++)
        padded[x + radius] = row[CLAMP(x, 0, width - 1)] * (1.0f / 255.0f);
    const float *middle = padded + radius;
    for (int x = 0; x < width; x++)
        dst[x] = weight[0] * middle[x];
    for (int k = 1; k <= radius; k++)
        fl_row_kernels()->add_pair(dst, middle - k, middle + k, weight[k], width);
}

/** Normalised one-sided kernel: weight[0] + 2 * (weight[1] + …) is 1. */
static float *make_kernel(float border_px, int *radius)
{
    *radius = border_px > 0.0f ? (int)border_px : 0;
    float *weight = g_new(float, *radius + 1);
    weight[0] = 1.0f;
    if (*radius > 0)
        fl_gauss_weights(weight, *radius, border_px / 3.0);
    double sum = weight[0];
    for (int k = 1; k <= *radius; k++)
        sum += 2.0 * weight[k];
    for (int k = 0; k <= *radius; k++)
        weight[k] = (float)(weight[k] / sum);
    return weight;
}

bool fl_shape_blur(const uint8_t *mask, int width, int height, float border_px, float *shape,
                   GError **error)
{
    int radius;
    g_autofree float *weight = make_kernel(border_px, &radius);
    g_autofree float *rows =
        fl_alloc((size_t)width * height, sizeof *rows, "a blurred mask", error);
    if (!rows)
        return false;
#pragma omp parallel
    {
        g_autofree float *padded = g_new(float, width + 2 * (size_t)radius);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            blur_row(mask + y * (size_t)width, width, weight, radius, padded,
                     rows + y * (size_t)width);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++) {
            float *dst = shape + y * (size_t)width;
            const float *middle = rows + y * (size_t)width;
            for (int x = 0; x < width; x++)
                dst[x] = weight[0] * middle[x];
            for (int k = 1; k <= radius; k++)
                fl_row_kernels()->add_pair(dst, rows + MAX(y - k, 0) * (size_t)width,
                                           rows + MIN(y + k, height - 1) * (size_t)width, weight[k],
                                           width);
        }
    }
    return true;
}

void fl_shape_ramp(const float *distance, int width, int height, float border_px, float *shape)
{
    const float scale = border_px > 0.0f ? 1.0f / border_px : INFINITY;
    for (size_t p = 0; p < (size_t)width * height; p++)
        shape[p] = distance[p] > 0.0f ? MIN(distance[p] * scale, 1.0f) : 0.0f;
}

#define EDGE_SHARE 0.8f // of the smoothstep; the ramp's share keeps depths apart down to the border

void fl_shape_edge(const float *distance, int width, int height, float border_px, float edge_px,
                   float *shape)
{
    fl_shape_ramp(distance, width, height, border_px, shape);
    const float scale = edge_px > 0.0f ? 0.5f / edge_px : INFINITY;
    for (size_t p = 0; p < (size_t)width * height; p++) {
        const float from = distance[p] + edge_px;
        const float t = from > 0.0f ? MIN(from * scale, 1.0f) : 0.0f;
        shape[p] = EDGE_SHARE * (t * t * (3.0f - 2.0f * t)) + (1.0f - EDGE_SHARE) * shape[p];
    }
}
