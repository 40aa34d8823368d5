#include "lazy/lazy_state.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

#define HALF 32 // samples on each side at most

typedef struct Blur {
    const uint16_t *rgba;
    const float *motion;
    int width, height;
    bool multiplied;
} Blur;

typedef struct Sum {
    float rgb[3], alpha, weight, rgb_weight;
} Sum;

/* Weighs straight colours by their alpha + 1, so that transparent ones count a little. */
static void add(const Blur *blur, float x, float y, float weight, Sum *sum)
{
    const int u = CLAMP((int)lrintf(x), 0, blur->width - 1);
    const int v = CLAMP((int)lrintf(y), 0, blur->height - 1);
    const uint16_t *at = blur->rgba + 4 * ((size_t)v * (size_t)blur->width + (size_t)u);
    const float w = blur->multiplied ? weight : weight * ((float)at[3] + 1);
    for (int c = 0; c < 3; c++)
        sum->rgb[c] += w * (float)at[c];
    sum->rgb_weight += w;
    sum->alpha += weight * (float)at[3];
    sum->weight += weight;
}

/* Follows the flow from a pixel, in steps of a pixel at most. */
static void follow(const Blur *blur, int x, int y, float sign, float step, int n, float sigma,
                   Sum *sum)
{
    float px = (float)x, py = (float)y;
    for (int k = 1; k <= n; k++) {
        const int u = CLAMP((int)lrintf(px), 0, blur->width - 1);
        const int v = CLAMP((int)lrintf(py), 0, blur->height - 1);
        const float *m = blur->motion + 2 * ((size_t)v * (size_t)blur->width + (size_t)u);
        const float length = sqrtf(m[0] * m[0] + m[1] * m[1]);
        if (!(length > 0))
            return;
        px += sign * step * m[0] / length, py += sign * step * m[1] / length;
        const float s = (float)k * step / sigma;
        add(blur, px, py, (float)exp(-s * s / 2), sum);
    }
}

static void blur_pixel(const Blur *blur, int x, int y, float shutter, uint16_t *out)
{
    const float *m = blur->motion + 2 * ((size_t)y * (size_t)blur->width + (size_t)x);
    const float sigma = shutter * sqrtf(m[0] * m[0] + m[1] * m[1]) / 4;
    if (!(sigma > 1e-3f))
        return;
    const int n = CLAMP((int)ceilf(2 * sigma), 1, HALF);
    const float step = 2 * sigma / (float)n;
    Sum sum = {0};
    add(blur, (float)x, (float)y, 1, &sum);
    follow(blur, x, y, 1, step, n, sigma, &sum);
    follow(blur, x, y, -1, step, n, sigma, &sum);
    for (int c = 0; c < 3; c++)
        out[c] = (uint16_t)(sum.rgb[c] / sum.rgb_weight + .5f);
    out[3] = (uint16_t)(sum.alpha / sum.weight + .5f);
}

uint16_t *fl_motion_blur(const uint16_t *rgba, const float *motion, int width, int height,
                         bool multiplied, float shutter, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    uint16_t *out = fl_alloc(4 * pixels, sizeof *out, "a blurred picture", error);
    if (!out)
        return NULL;
    memcpy(out, rgba, 4 * pixels * sizeof *out);
    const Blur blur = {rgba, motion, width, height, multiplied};
#pragma omp parallel for schedule(static)
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            blur_pixel(&blur, x, y, shutter, out + 4 * ((size_t)y * (size_t)width + (size_t)x));
    return out;
}
