#include "style/resample.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

FlPicture *fl_picture_crop(const FlPicture *picture, int x, int y, int width, int height,
                           GError **error)
{
    g_assert(x >= 0 && y >= 0 && width <= picture->width - x && height <= picture->height - y);
    g_autoptr(FlPicture) part = fl_picture_new(width, height, error);
    for (int row = 0; part && row < height; row++)
        memcpy(part->rgba + (size_t)row * width * 4,
               picture->rgba + ((size_t)(y + row) * picture->width + x) * 4, (size_t)width * 4);
    return g_steal_pointer(&part);
}

/* Catmull and Rom's. Unlike a tent it leaves fine grain nearly as strong as it is, whichever phase
 * the new samples have, so that paint looks alike at sizes just above and below that of the
 * recording. */
static float cubic(float t)
{
    t = fabsf(t);
    if (t < 1)
        return (1.5f * t - 2.5f) * t * t + 1;
    return t < 2 ? ((-.5f * t + 2.5f) * t - 4) * t + 2 : 0;
}

void fl_resample_line(const float *from, int from_n, size_t from_step, float *to, int to_n,
                      size_t to_step)
{
    const float ratio = (float)from_n / (float)to_n, wide = ratio > 1 ? ratio : 1;
    for (int i = 0; i < to_n; i++) {
        const float centre = ((float)i + 0.5f) * ratio - 0.5f;
        const int first = MAX(0, (int)ceilf(centre - 2 * wide));
        const int last = MIN(from_n - 1, (int)floorf(centre + 2 * wide));
        float sum = 0, weight = 0;
        for (int k = first; k <= last; k++) {
            const float w = cubic(((float)k - centre) / wide);
            sum += w * from[k * from_step];
            weight += w;
        }
        to[i * to_step] = sum / weight;
    }
}

/* Colours are weighted by alpha, so that transparent pixels lend no colour. */
static void weigh_row(const uint8_t *rgba, int width, float *weighted)
{
    for (int x = 0; x < width; x++, rgba += 4, weighted += 4) {
        for (int c = 0; c < 3; c++)
            weighted[c] = (float)(rgba[c] * rgba[3]);
        weighted[3] = rgba[3];
    }
}

static void unweigh_row(const float *weighted, int width, uint8_t *rgba)
{
    for (int x = 0; x < width; x++, rgba += 4, weighted += 4) {
        for (int c = 0; c < 3; c++)
            rgba[c] =
                weighted[3] > 0 ? (uint8_t)(CLAMP(weighted[c] / weighted[3], 0, 255) + 0.5f) : 0;
        rgba[3] = (uint8_t)(CLAMP(weighted[3], 0, 255) + 0.5f);
    }
}

FlPicture *fl_picture_resize(const FlPicture *picture, int width, int height, GError **error)
{
    const size_t from_row = 4 * (size_t)picture->width, row = 4 * (size_t)width;
    const int tallest = MAX(picture->height, height);
    g_autoptr(FlPicture) resized = fl_picture_new(width, height, error);
    g_autofree float *weighted =
        resized ? fl_alloc(from_row + 2 * row * tallest, sizeof(float), "a picture", error) : NULL;
    if (!weighted)
        return NULL;
    float *across = weighted + from_row, *both = across + row * tallest;
    for (int y = 0; y < picture->height; y++) {
        weigh_row(picture->rgba + y * from_row, picture->width, weighted);
        for (int c = 0; c < 4; c++)
            fl_resample_line(weighted + c, picture->width, 4, across + y * row + c, width, 4);
    }
    for (size_t k = 0; k < row; k++)
        fl_resample_line(across + k, picture->height, row, both + k, height, row);
    for (int y = 0; y < height; y++)
        unweigh_row(both + y * row, width, resized->rgba + y * row);
    return g_steal_pointer(&resized);
}
