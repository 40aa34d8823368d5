#include "style/estimate.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include "guides/gauss.h"
#include "style/flat_field.h"

#include <math.h>
#include <string.h>

/* The constants below are pixels and 8-bit levels, tried on seven recordings and simulations. */
static const float SMOOTH_PX = 1.5f;    // removes grain before the threshold
static const float MARGIN_PX = 2;       // smooths the outline after it
static const float MARGIN_CUT = 0.4f;   // below one half: the mask reaches half a pixel further
static const float FAINTEST = 5;        // a smaller difference from the paper is never paint
static const float NOISES = 4;          // nor is less than so many times the paper's noise
static const float SHARPNESS = 6;       // a strong edge, smoothed, is cut at a sixth of its middle
static const double KEEP_SHARE = 0.04;  // of the largest part: smaller parts are specks
static const double HOLE_SHARE = 0.005; // of the largest part: smaller holes are grain

bool fl_blur_recording(float *plane, int width, int height, float sigma_px, GError **error)
{
    const int radius = (int)ceilf(3 * sigma_px);
    g_autofree float *weight = g_new(float, radius + 1);
    float sum = 0;
    fl_gauss_weights(weight, radius, sigma_px);
    for (int k = radius; k >= 0; k--)
        sum += (k ? 2 : 1) * weight[k];
    return fl_blur_with(plane, width, height, &(FlBlurKernel){radius, weight, sum}, error);
}

double fl_mask_share(const uint8_t *mask, int width, int height)
{
    const size_t pixels = (size_t)width * height;
    uint64_t sum = 0;
    for (size_t i = 0; i < pixels; i++)
        sum += mask[i];
    return (double)sum / 255 / (double)pixels;
}

/*
 * The largest channel's difference from the plate, in levels. The difference is smoothed while it
 * still has its sign: grain, which is lighter and darker, vanishes, and thin paint stays.
 */
static bool difference(const FlClip *clip, int frame, const FlFlatField *plate, float *channel,
                       float *most, GError **error)
{
    const int width = clip->width, height = clip->height;
    const size_t pixels = (size_t)width * height;
    memset(most, 0, pixels * sizeof(float));
    for (int c = 0; c < 3; c++) {
        const uint8_t *rgb = clip->rgb + frame * pixels * 3 + c;
        for (int y = 0; y < height; y++)
            for (int x = 0; x < width; x++, rgb += 3)
                channel[y * (size_t)width + x] = *rgb - fl_flat_field_at(plate, x, y, c);
        if (!fl_blur_recording(channel, width, height, SMOOTH_PX, error))
            return false;
        for (size_t i = 0; i < pixels; i++)
            most[i] = MAX(most[i], fabsf(channel[i]));
    }
    return true;
}

/* Otsu's threshold [Otsu79]: the bin that splits a histogram of 256 into the two most different
 * classes. */
static int otsu_threshold(const uint32_t count[256])
{
    double n = 0, total = 0, below = 0, sum_below = 0, best = -1;
    int between = 0;
    for (int i = 0; i < 256; i++) {
        n += count[i];
        total += (double)i * count[i];
    }
    for (int i = 0; i < 255; i++) {
        below += count[i];
        sum_below += (double)i * count[i];
        const double above = n - below;
        if (below == 0 || above == 0)
            continue;
        const double gap = sum_below / below - (total - sum_below) / above;
        if (below * above * gap * gap > best) {
            best = below * above * gap * gap;
            between = i + 1;
        }
    }
    return between;
}

/*
 * Where paint begins, in levels of difference, from a frame that holds both paint and paper: above
 * the paper's noise, since thin paint is paint too, and below the middle between the two.
 */
static float choose_threshold(const float *most, size_t pixels)
{
    uint32_t count[256] = {0}, bare = 0, sum = 0;
    for (size_t i = 0; i < pixels; i++)
        count[CLAMP((int)most[i], 0, 255)]++;
    const int between = otsu_threshold(count);
    for (int i = 0; i < between; i++)
        bare += count[i];
    int median = 0;
    while (2 * (sum += count[median]) < bare)
        median++;
    const float noise = MIN(NOISES * ((float)median + 0.5f), (float)between);
    return MAX(FAINTEST, MAX(noise, (float)between / SHARPNESS));
}

/* Collects the 4-connected pixels of `value` around `start` into `part` and sets them to 2. */
static size_t flood(uint8_t *binary, int width, int height, size_t start, uint8_t value,
                    uint32_t *part)
{
    size_t n = 0;
    part[n++] = (uint32_t)start;
    binary[start] = 2;
    for (size_t i = 0; i < n; i++) {
        const size_t p = part[i], x = p % width;
        const size_t near[] = {p - 1, p + 1, p - width, p + width};
        const bool there[] = {x > 0, x + 1 < (size_t)width, p >= (size_t)width,
                              p + width < (size_t)width * height};
        for (int k = 0; k < 4; k++)
            if (there[k] && binary[near[k]] == value) {
                binary[near[k]] = 2;
                part[n++] = (uint32_t)near[k];
            }
    }
    return n;
}

/* Inverts connected parts of `value` with less than `least` pixels. Returns: the largest part. */
static size_t drop_small_parts(uint8_t *binary, int width, int height, uint8_t value, size_t least,
                               uint32_t *part)
{
    const size_t pixels = (size_t)width * height;
    size_t largest = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (binary[i] != value)
            continue;
        const size_t n = flood(binary, width, height, i, value, part);
        largest = MAX(largest, n);
        if (n < least)
            for (size_t k = 0; k < n; k++)
                binary[part[k]] = !value;
    }
    for (size_t i = 0; i < pixels; i++)
        if (binary[i] == 2)
            binary[i] = value;
    return largest;
}

/* The blurred outline's slope at the cut gives antialiased coverage. */
static bool binary_to_coverage(const uint8_t *binary, int width, int height, float *plane,
                               uint8_t *mask, GError **error)
{
    const size_t pixels = (size_t)width * height;
    const float slope = 0.35f / MARGIN_PX; // of a straight step blurred by MARGIN_PX, at the cut
    for (size_t i = 0; i < pixels; i++)
        plane[i] = binary[i];
    if (!fl_blur_recording(plane, width, height, MARGIN_PX, error))
        return false;
    for (size_t i = 0; i < pixels; i++)
        mask[i] = (uint8_t)(255 * CLAMP(0.5f + (plane[i] - MARGIN_CUT) / slope, 0, 1) + 0.5f);
    return true;
}

/* Clears the parts of `binary` that do not touch the next frame's paint: dirt comes and goes. */
static void drop_strays(uint8_t *binary, const uint8_t *next, int width, int height, uint32_t *part)
{
    const size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++) {
        if (binary[i] != 1)
            continue;
        const size_t n = flood(binary, width, height, i, 1, part);
        size_t touching = 0;
        for (size_t k = 0; k < n; k++)
            touching += next[part[k]] > 0;
        for (size_t k = 0; k < n && touching == 0; k++)
            binary[part[k]] = 0;
    }
    for (size_t i = 0; i < pixels; i++)
        binary[i] = binary[i] > 0;
}

/* Binary paint of one frame in its largest parts, without pinholes; next is NULL for the last. */
static void find_parts(const float *most, float threshold, int width, int height,
                       const uint8_t *next, uint8_t *binary, uint32_t *part)
{
    const size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++)
        binary[i] = most[i] > threshold;
    if (next)
        drop_strays(binary, next, width, height, part);
    const double largest = (double)drop_small_parts(binary, width, height, 1, 0, part);
    drop_small_parts(binary, width, height, 1, (size_t)(KEEP_SHARE * largest), part);
    drop_small_parts(binary, width, height, 0, (size_t)(HOLE_SHARE * largest), part);
}

bool fl_extract_masks(const FlClip *clip, const uint8_t paper[3], uint8_t *mask, GError **error)
{
    const int width = clip->width, height = clip->height, last = clip->n_frames - 1;
    const size_t pixels = (size_t)width * height;
    g_autofree float *channel = fl_alloc(pixels, sizeof(float), "a mask", error);
    g_autofree float *most = fl_alloc(pixels, sizeof(float), "a mask", error);
    g_autofree uint8_t *binary = fl_alloc(pixels, 1, "a mask", error);
    g_autofree uint32_t *part = fl_alloc(pixels, sizeof(uint32_t), "a mask", error);
    if (!channel || !most || !binary || !part)
        return false;
    FlFlatField plate;
    float threshold = 0;
    fl_flat_field_fit(&plate, clip, NULL, paper);
    for (int frame = last; frame >= 0; frame--) { // backwards, from the frame with the most paint
        uint8_t *coverage = mask + frame * pixels;
        if (!difference(clip, frame, &plate, channel, most, error))
            return false;
        if (frame == last)
            threshold = choose_threshold(most, pixels);
        find_parts(most, threshold, width, height, frame == last ? NULL : coverage + pixels, binary,
                   part);
        if (!binary_to_coverage(binary, width, height, channel, coverage, error))
            return false;
    }
    return true;
}
