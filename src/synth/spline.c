#include "synth/spline.h"

#include <glib.h>

#define POLE -0.267949192431122706f // sqrt(3) - 2
#define HORIZON 16                  // POLE^16 is below an 8-bit level by far

/* Causal, then anticausal recursive filter over n values that are `step` floats apart. */
static void filter_line(float *line, int n, size_t step)
{
    if (n == 1)
        return;
    float sum = 0, power = 1;
    for (int k = 0; k < MIN(n, HORIZON); k++, power *= POLE)
        sum += power * line[k * step];
    line[0] = 6 * sum;
    for (int k = 1; k < n; k++)
        line[k * step] = 6 * line[k * step] + POLE * line[(k - 1) * step];
    line[(n - 1) * step] =
        (POLE / (POLE * POLE - 1)) * (line[(n - 1) * step] + POLE * line[(n - 2) * step]);
    for (int k = n - 2; k >= 0; k--)
        line[k * step] = POLE * (line[(k + 1) * step] - line[k * step]);
}

void fl_spline_prefilter(float *const plane[3], int width, int height, float *coefficients)
{
    for (size_t p = 0; p < (size_t)width * height; p++)
        for (int c = 0; c < 3; c++)
            coefficients[3 * p + c] = plane[c][p];
    for (int c = 0; c < 3; c++) {
        for (int y = 0; y < height; y++)
            filter_line(coefficients + 3 * (size_t)y * width + c, width, 3);
        for (int x = 0; x < width; x++)
            filter_line(coefficients + 3 * (size_t)x + c, height, 3 * (size_t)width);
    }
}

/* Cubic B-spline weights of the four nearest pixels, phase in 1/16 pixel. */
static void weights(int phase, float w[4])
{
    const float t = (float)phase / 16, u = 1 - t;
    w[0] = u * u * u / 6;
    w[1] = (4 - 6 * t * t + 3 * t * t * t) / 6;
    w[2] = (4 - 6 * u * u + 3 * u * u * u) / 6;
    w[3] = t * t * t / 6;
}

static int mirror(int i, int n)
{
    if (n == 1)
        return 0;
    i = i < 0 ? -i : i;
    return i < n ? i : 2 * n - 2 - i;
}

void fl_spline_sample(const float *coefficients, int width, int height, int x_16, int y_16,
                      float value[3])
{
    x_16 = CLAMP(x_16, 0, 16 * (width - 1));
    y_16 = CLAMP(y_16, 0, 16 * (height - 1));
    float wx[4], wy[4];
    weights(x_16 & 15, wx);
    weights(y_16 & 15, wy);
    int column[4];
    for (int i = 0; i < 4; i++)
        column[i] = CLAMP(mirror((x_16 >> 4) + i - 1, width), 0, width - 1);
    value[0] = value[1] = value[2] = 0;
    for (int j = 0; j < 4; j++) {
        const int row = CLAMP(mirror((y_16 >> 4) + j - 1, height), 0, height - 1);
        const float *line = coefficients + 3 * (size_t)row * width;
        for (int c = 0; c < 3; c++)
            value[c] += wy[j] * (wx[0] * line[3 * column[0] + c] + wx[1] * line[3 * column[1] + c] +
                                 wx[2] * line[3 * column[2] + c] + wx[3] * line[3 * column[3] + c]);
    }
}
