#include "guides/blur.h"

#include "base/alloc.h"
#include "base/cpu.h"
#include "guides/gauss.h"

static void divide(float *row, int width, float sum)
{
    for (int x = 0; x < width && sum != 1; x++)
        row[x] /= sum;
}

/** to[i] += weight * (a[i] + b[i]); a and b may be the same. */
static inline void add_row_pair(float *restrict to, const float *a, const float *b, float weight,
                                int n)
{
    for (int i = 0; i < n; i++)
        to[i] += weight * (a[i] + b[i]);
}

FL_FOR_EACH_CPU(add_pair, add_row_pair,
                (float *to, const float *a, const float *b, float weight, int n),
                (to, a, b, weight, n))

/** Blurs a row along x, through a copy with its ends repeated: width + 2 * radius. */
static void blur_row(const float *row, int width, const FlBlurKernel *kernel, float *padded,
                     float *out)
{
    const int radius = kernel->radius;
    for (int x = -radius; x < width + radius; x++)
        padded[x + radius] = row[CLAMP(x, 0, width - 1)];
    const float *middle = padded + radius;
    for (int x = 0; x < width; x++)
        out[x] = kernel->weight[0] * middle[x];
    for (int k = 1; k <= radius; k++)
        add_pair(out, middle - k, middle + k, kernel->weight[k], width);
    divide(out, width, kernel->sum);
}

/** Blurs row y along y. */
static void blur_columns(const float *rows, int width, int height, int y,
                         const FlBlurKernel *kernel, float *out)
{
    const float *middle = rows + y * (size_t)width;
    for (int x = 0; x < width; x++)
        out[x] = kernel->weight[0] * middle[x];
    for (int k = 1; k <= kernel->radius; k++)
        add_pair(out, rows + MAX(y - k, 0) * (size_t)width,
                 rows + MIN(y + k, height - 1) * (size_t)width, kernel->weight[k], width);
    divide(out, width, kernel->sum);
}

bool fl_blur_with(float *plane, int width, int height, const FlBlurKernel *kernel, GError **error)
{
    g_autofree float *rows = fl_alloc_unset((size_t)width * height, sizeof *rows, "a blur", error);
    if (!rows)
        return false;
#pragma omp parallel
    {
        g_autofree float *padded = g_new(float, width + 2 * (size_t)kernel->radius);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            blur_row(plane + y * (size_t)width, width, kernel, padded, rows + y * (size_t)width);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++)
            blur_columns(rows, width, height, y, kernel, plane + y * (size_t)width);
    }
    return true;
}

bool fl_blur(float *plane, int width, int height, float sigma_px, GError **error)
{
    const int radius = (int)(3 * sigma_px);
    g_autofree float *weight = g_new0(float, radius + 1);
    fl_gauss_weights(weight, radius, sigma_px);
    float sum = weight[0];
    for (int k = 1; k <= radius; k++)
        sum += 2 * weight[k];
    for (int k = 0; k <= radius; k++)
        weight[k] /= sum;
    return fl_blur_with(plane, width, height, &(FlBlurKernel){radius, weight, 1}, error);
}
