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

/* The source samples of one sample, which is their weighted sum divided by the sum of the weights.
 */
typedef struct Taps {
    int first, n;
    float sum;
} Taps;

struct FlResampling {
    int n, most; // samples; taps of any
    Taps *taps;
    float *weight; // `most` for each sample
};

FlResampling *fl_resampling_new(int from_n, int to_n)
{
    const float ratio = (float)from_n / (float)to_n, wide = ratio > 1 ? ratio : 1;
    FlResampling *resampling = g_new(FlResampling, 1);
    *resampling = (FlResampling){to_n, (int)(4 * wide) + 2, g_new0(Taps, to_n), NULL};
    resampling->weight = g_new0(float, (size_t)to_n * resampling->most);
    for (int i = 0; i < to_n; i++) {
        Taps *taps = &resampling->taps[i];
        float *weight = resampling->weight + (size_t)i * resampling->most;
        const float centre = ((float)i + 0.5f) * ratio - 0.5f;
        const int last = MIN(from_n - 1, (int)floorf(centre + 2 * wide));
        taps->first = MAX(0, (int)ceilf(centre - 2 * wide));
        for (int k = taps->first; k <= last; k++) {
            weight[taps->n] = cubic(((float)k - centre) / wide);
            taps->sum += weight[taps->n++];
        }
    }
    return resampling;
}

void fl_resampling_free(FlResampling *resampling)
{
    if (!resampling)
        return;
    g_free(resampling->taps);
    g_free(resampling->weight);
    g_free(resampling);
}

void fl_resample_row(const FlResampling *resampling, const float *from, int channels, float *to)
{
    for (int i = 0; i < resampling->n; i++) {
        const Taps *taps = &resampling->taps[i];
        const float *weight = resampling->weight + (size_t)i * resampling->most;
        for (int c = 0; c < channels; c++) {
            const float *sample = from + (size_t)taps->first * channels + c;
            float sum = 0;
            for (int k = 0; k < taps->n; k++)
                sum += weight[k] * sample[(size_t)k * channels];
            *to++ = sum / taps->sum;
        }
    }
}

void fl_resample_columns(const FlResampling *resampling, const float *from, size_t row, int k,
                         float *to)
{
    const Taps *taps = &resampling->taps[k];
    const float *weight = resampling->weight + (size_t)k * resampling->most;
    memset(to, 0, row * sizeof *to);
    for (int j = 0; j < taps->n; j++) {
        const float *sample = from + (size_t)(taps->first + j) * row;
        for (size_t x = 0; x < row; x++)
            to[x] += weight[j] * sample[x];
    }
    for (size_t x = 0; x < row; x++)
        to[x] /= taps->sum;
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
    g_autoptr(FlPicture) resized = fl_picture_new(width, height, error);
    g_autofree float *weighted = resized ? fl_alloc(from_row + row * (picture->height + 1),
                                                    sizeof(float), "a picture", error)
                                         : NULL;
    if (!weighted)
        return NULL;
    float *across = weighted + from_row, *both = across + row * picture->height;
    g_autoptr(FlResampling) rows = fl_resampling_new(picture->width, width);
    g_autoptr(FlResampling) columns = fl_resampling_new(picture->height, height);
    for (int y = 0; y < picture->height; y++) {
        weigh_row(picture->rgba + y * from_row, picture->width, weighted);
        fl_resample_row(rows, weighted, 4, across + y * row);
    }
    for (int y = 0; y < height; y++) {
        fl_resample_columns(columns, across, row, y, both);
        unweigh_row(both, width, resized->rgba + y * row);
    }
    return g_steal_pointer(&resized);
}
