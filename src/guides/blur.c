#include "guides/blur.h"

#include "base/alloc.h"
#include "guides/gauss.h"

/* One line, through a copy with the ends repeated; values are `step` floats apart. */
static void blur_line(float *line, int n, size_t step, const float *weight, int radius,
                      float *padded)
{
    for (int i = -radius; i < n + radius; i++)
        padded[i + radius] = line[CLAMP(i, 0, n - 1) * step];
    for (int i = 0; i < n; i++) {
        const float *middle = padded + radius + i;
        float sum = weight[0] * middle[0];
        for (int k = 1; k <= radius; k++)
            sum += weight[k] * (middle[-k] + middle[k]);
        line[i * step] = sum;
    }
}

bool fl_blur(float *plane, int width, int height, float sigma_px, GError **error)
{
    const int radius = (int)(3 * sigma_px);
    g_autofree float *weight = g_new(float, radius + 1);
    g_autofree float *padded =
        fl_alloc(MAX(width, height) + 2 * (size_t)radius, sizeof *padded, "a blur", error);
    if (!padded)
        return false;
    weight[0] = 1;
    fl_gauss_weights(weight, radius, sigma_px);
    float sum = weight[0];
    for (int k = 1; k <= radius; k++)
        sum += 2 * weight[k];
    for (int k = 0; k <= radius; k++)
        weight[k] /= sum;
    for (int y = 0; y < height; y++)
        blur_line(plane + y * (size_t)width, width, 1, weight, radius, padded);
    for (int x = 0; x < width; x++)
        blur_line(plane + x, height, (size_t)width, weight, radius, padded);
    return true;
}
