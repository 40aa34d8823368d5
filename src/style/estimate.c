#include "style/estimate.h"

#include "base/alloc.h"
#include "guides/blur.h"
#include "guides/connected_parts.h"
#include "guides/gauss.h"

#include <math.h>
#include <string.h>

/* The constants below are pixels and 8-bit levels, tried on seven recordings and simulations. */
static const float SMOOTH_PX = 1.5f;    // removes grain before the threshold
static const float MARGIN_PX = 2;       // smooths the outline after the threshold
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
 * The least difference of paint from paper, in levels, from a frame with both paint and paper: just
 * above the paper's noise, to include thin paint, and below the threshold between the two.
 */
static float choose_threshold(const float *most, size_t pixels)
{
    uint32_t count[256] = {0};
    for (size_t i = 0; i < pixels; i++)
        count[CLAMP((int)most[i], 0, 255)]++;
    const int between = otsu_threshold(count);
    const float median = (float)fl_median_bin(count, between) + 0.5f; // of what is bare
    const float noise = MIN(NOISES * median, (float)between);
    return MAX(FAINTEST, MAX(noise, (float)between / SHARPNESS));
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
static bool drop_strays(uint8_t *binary, const uint8_t *next, int width, int height, GError **error)
{
    g_auto(FlConnectedParts) parts = {0};
    if (!fl_connected_parts_init(&parts, binary, width, height, 1, 1, error))
        return false;
    g_autofree bool *touches = g_new0(bool, (size_t)parts.n_parts + 1);
    for (size_t p = 0; p < parts.n_pixels; p++)
        touches[parts.part[p]] |= next[p] > 0;
    for (size_t p = 0; p < parts.n_pixels; p++)
        binary[p] = binary[p] && touches[parts.part[p]];
    return true;
}

/* Drops specks, then fills holes, both by their share of the largest part. */
static bool clean_parts(uint8_t *binary, int width, int height, GError **error)
{
    g_auto(FlConnectedParts) paint = {0}, bare = {0};
    if (!fl_connected_parts_init(&paint, binary, width, height, 1, 1, error))
        return false;
    uint32_t largest = 0;
    for (int part = 1; part <= paint.n_parts; part++)
        largest = MAX(largest, paint.size[part]);
    fl_connected_parts_drop(&paint, (size_t)(KEEP_SHARE * largest), 0, binary);
    if (!fl_connected_parts_init(&bare, binary, width, height, 0, 0, error))
        return false;
    fl_connected_parts_drop(&bare, (size_t)(HOLE_SHARE * largest), 1, binary);
    return true;
}

/* Binary paint of one frame in its largest parts, without pinholes; next is NULL for the last. */
static bool find_parts(const float *most, float threshold, int width, int height,
                       const uint8_t *next, uint8_t *binary, GError **error)
{
    const size_t pixels = (size_t)width * height;
    for (size_t i = 0; i < pixels; i++)
        binary[i] = most[i] > threshold;
    return (!next || drop_strays(binary, next, width, height, error)) &&
           clean_parts(binary, width, height, error);
}

bool fl_extract_masks(const FlClip *clip, const uint8_t paper[3], uint8_t *mask, GError **error)
{
    const int width = clip->width, height = clip->height, last = clip->n_frames - 1;
    const size_t pixels = (size_t)width * height;
    g_autofree float *channel = fl_alloc(pixels, sizeof(float), "a mask", error);
    g_autofree float *most = fl_alloc(pixels, sizeof(float), "a mask", error);
    g_autofree uint8_t *binary = fl_alloc(pixels, 1, "a mask", error);
    if (!channel || !most || !binary)
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
        if (!find_parts(most, threshold, width, height, frame == last ? NULL : coverage + pixels,
                        binary, error) ||
            !binary_to_coverage(binary, width, height, channel, coverage, error))
            return false;
    }
    return true;
}
