#include "lazy/fluid_shape.h"

#include "base/alloc.h"

/* Lowers a pixel of the filled plane to its neighbours, but not below alpha. */
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

/* Sweeps down and up until nothing changes: the same whatever the order. */
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

bool fl_fluid_shape(float *alpha, int width, int height, GError **error)
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
