#include "synth/spline.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#define POLE -0.267949192431122706f // sqrt(3) - 2
#define HORIZON 16                  // POLE^16 is below an 8-bit level by far

static FlSplinePhase phases[16];
const FlSplinePhase *fl_spline_phases = phases;

/* Cubic B-spline weights of the four nearest pixels. */
static void phase_init(FlSplinePhase *phase, double t)
{
    const double u = 1 - t;
    const double w[4] = {u * u * u / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
                         (4 - 6 * u * u + 3 * u * u * u) / 6, t * t * t / 6};
    int whole[4];
    for (int i = 0; i < 4; i++)
        whole[i] = (int)lrint(w[i] * 32768);
    whole[1] += 32768 - whole[0] - whole[1] - whole[2] - whole[3]; // flat colours stay
    for (int i = 0; i < 16; i++)
        phase->x[i] = (int16_t)whole[i / 8 * 2 + i % 2];
    for (int i = 0; i < 4; i++)
        phase->y[i] = (float)(w[i] / (FL_SPLINE_ONE * 32768.0));
}

void fl_spline_init(void)
{
    static gsize once;
    if (!g_once_init_enter(&once))
        return;
    for (int p = 0; p < 16; p++)
        phase_init(&phases[p], p / 16.0);
    g_once_init_leave(&once, 1);
}

/*
 * Causal, then anticausal recursive filter [Unser99] over n items of `row` values each, which are
 * filtered side by side: columns by whole rows, so that the compiler can use vectors.
 */
static void filter(float *v, int n, size_t row, float *sum)
{
    if (n == 1)
        return;
    memset(sum, 0, row * sizeof *sum);
    float power = 1;
    for (int k = 0; k < MIN(n, HORIZON); k++, power *= POLE)
        for (size_t i = 0; i < row; i++)
            sum[i] += power * v[k * row + i];
    for (size_t i = 0; i < row; i++)
        v[i] = 6 * sum[i];
    for (int k = 1; k < n; k++)
        for (size_t i = 0; i < row; i++)
            v[k * row + i] = 6 * v[k * row + i] + POLE * v[(k - 1) * row + i];
    float *last = v + (n - 1) * row;
    for (size_t i = 0; i < row; i++)
        last[i] = (POLE / (POLE * POLE - 1)) * (last[i] + POLE * (last - row)[i]);
    for (int k = n - 2; k >= 0; k--)
        for (size_t i = 0; i < row; i++)
            v[k * row + i] = POLE * (v[(k + 1) * row + i] - v[k * row + i]);
}

static int mirror(int i, int n)
{
    const int m = i < 0 ? -i : i < n ? i : 2 * n - 2 - i;
    return CLAMP(m, 0, n - 1);
}

/* NULL: zeros. */
static void pack_channel(const float *plane, int c, int width, int height, FlSplinePixel *out,
                         int pitch)
{
    for (int y = -FL_SPLINE_PAD; y < height + FL_SPLINE_PAD; y++) {
        const size_t row = (size_t)mirror(y, height) * (size_t)width;
        for (int x = -FL_SPLINE_PAD; x < width + FL_SPLINE_PAD; x++) {
            const float value = plane ? plane[row + (size_t)mirror(x, width)] : 0;
            out[y * (ptrdiff_t)pitch + x].c[c] =
                (int16_t)CLAMP(lrintf(value * FL_SPLINE_ONE), -32767, 32767);
        }
    }
}

void fl_spline_prefilter_channel(float *plane, int c, int width, int height,
                                 FlSplinePixel *coefficients, int pitch)
{
    g_autofree float *sum = g_new(float, width);
    for (int y = 0; y < height; y++)
        filter(plane + (size_t)y * width, width, 1, sum);
    filter(plane, height, width, sum);
    pack_channel(plane, c, width, height, coefficients, pitch);
}

void fl_spline_prefilter(float *const *plane, int n, int width, int height,
                         FlSplinePixel *coefficients, int pitch)
{
    for (int c = 0; c < n; c++)
        fl_spline_prefilter_channel(plane[c], c, width, height, coefficients, pitch);
    for (int c = n; c < 4; c++)
        pack_channel(NULL, c, width, height, coefficients, pitch);
}
