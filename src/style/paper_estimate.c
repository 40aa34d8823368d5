#include "style/estimate.h"

static void median_outside(const FlClip *clip, const uint8_t *mask, uint8_t paper[3])
{
    const size_t pixels = (size_t)clip->width * clip->height * clip->n_frames;
    uint32_t histogram[3][256] = {{0}};
    size_t bare = 0;
    for (size_t i = 0; i < pixels; i++)
        if (mask[i] == 0) {
            bare++;
            for (int c = 0; c < 3; c++)
                histogram[c][clip->rgb[3 * i + c]]++;
        }
    for (int c = 0; c < 3; c++)
        paper[c] = bare > pixels / 1000 ? (uint8_t)fl_median_bin(histogram[c], 256) : 255;
}

enum { BINS = 32, BIN = 256 / BINS };

static int bin_of(int r, int g, int b)
{
    return (r * BINS + g) * BINS + b;
}

/* The fullest 3x3x3 cube of bins: a peak that lies across bins still counts as one. */
static void fullest_bin(const uint32_t *count, int best[3])
{
    uint64_t most = 0;
    for (int r = 1; r < BINS - 1; r++)
        for (int g = 1; g < BINS - 1; g++)
            for (int b = 1; b < BINS - 1; b++) {
                uint64_t sum = 0;
                for (int k = 0; k < 27; k++)
                    sum += count[bin_of(r + k / 9 - 1, g + k / 3 % 3 - 1, b + k % 3 - 1)];
                if (sum > most) {
                    most = sum;
                    best[0] = r, best[1] = g, best[2] = b;
                }
            }
}

static bool on_rim(const FlClip *clip, int x, int y)
{
    const int rim = 1 + MIN(clip->width, clip->height) / 12;
    return x < rim || y < rim || x >= clip->width - rim || y >= clip->height - rim;
}

static bool near_bin(const uint8_t *pixel, const int bin[3])
{
    for (int c = 0; c < 3; c++)
        if (abs(pixel[c] / BIN - bin[c]) > 1)
            return false;
    return true;
}

static void commonest_on_rim(const FlClip *clip, uint8_t paper[3])
{
    g_autofree uint32_t *count = g_new0(uint32_t, BINS * BINS * BINS);
    uint32_t histogram[3][256] = {{0}};
    int bin[3] = {BINS - 2, BINS - 2, BINS - 2};
    for (int pass = 0; pass < 2; pass++) {
        const uint8_t *pixel = clip->rgb;
        for (int y = 0; y < clip->height; y++)
            for (int x = 0; x < clip->width; x++, pixel += 3) {
                if (!on_rim(clip, x, y))
                    continue;
                if (pass == 0)
                    count[bin_of(pixel[0] / BIN, pixel[1] / BIN, pixel[2] / BIN)]++;
                else if (near_bin(pixel, bin))
                    for (int c = 0; c < 3; c++)
                        histogram[c][pixel[c]]++;
            }
        if (pass == 0)
            fullest_bin(count, bin);
    }
    for (int c = 0; c < 3; c++)
        paper[c] = (uint8_t)fl_median_bin(histogram[c], 256);
}

void fl_paper_estimate(const FlClip *clip, const uint8_t *mask, uint8_t paper[3])
{
    if (mask)
        median_outside(clip, mask, paper);
    else
        commonest_on_rim(clip, paper);
}
