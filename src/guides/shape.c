#include "guides/blur.h"
#include "guides/gauss.h"
#include "guides/guides.h"
#include <math.h>

/** One side of a Gaussian: weight[0] + 2 * (weight[1] + …) is 1. */
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
    for (size_t p = 0; p < (size_t)width * height; p++)
        shape[p] = mask[p] * (1.0f / 255.0f);
    return fl_blur_with(shape, width, height, &(FlBlurKernel){radius, weight, 1}, error);
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
