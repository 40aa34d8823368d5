#include "style/extract.h"

#include "base/alloc.h"

#include <math.h>
#include <string.h>

/* The constants below are pixels and 8-bit levels, tried on seven recordings and simulations. */
static const float SMOOTH_PX = 1.5f;    // removes grain before the threshold
static const float MARGIN_PX = 2;       // smooths the outline after it
static const float MARGIN_CUT = 0.3f;   // below one half: the mask reaches about one pixel further
static const float FAINTEST = 7;        // a smaller difference from the paper is never paint
static const float BOLDEST = 30;        // a larger difference always is
static const double KEEP_SHARE = 0.02;  // of the largest part: smaller parts are specks
static const double HOLE_SHARE = 0.005; // of the largest part: smaller holes are grain

bool fl_blur_plane(float *plane, int width, int height, float sigma, GError **error)
{
    const int radius = (int)ceilf(3 * sigma), longest = MAX(width, height);
    g_autofree float *kernel = fl_alloc(radius + 1, sizeof(float), "a kernel", error);
    g_autofree float *line = fl_alloc(longest + 2 * radius, sizeof(float), "a line", error);
    if (!kernel || !line)
        return false;
    float sum = 0;
    for (int i = radius; i >= 0; i--)
        sum += (i ? 2 : 1) * (kernel[i] = expf(-0.5f * i * i / (sigma * sigma)));
    for (int pass = 0; pass < 2; pass++) {
        const int lines = pass ? width : height, length = pass ? height : width;
        const ptrdiff_t step = pass ? width : 1, next = pass ? 1 : width;
        for (int l = 0; l < lines; l++) {
            float *first = plane + l * next;
            for (int i = -radius; i < length + radius; i++)
                line[i + radius] = first[CLAMP(i, 0, length - 1) * step];
            for (int i = 0; i < length; i++) {
                const float *centre = line + i + radius;
                float blurred = kernel[0] * centre[0];
                for (int k = 1; k <= radius; k++)
                    blurred += kernel[k] * (centre[-k] + centre[k]);
                first[i * step] = blurred / sum;
            }
        }
    }
    return true;
}

double fl_mask_share(const uint8_t *mask, int width, int height)
{
    const size_t pixels = (size_t)width * height;
    uint64_t sum = 0;
    for (size_t i = 0; i < pixels; i++)
        sum += mask[i];
    return (double)sum / 255 / (double)pixels;
}

/* The largest channel's difference from the paper, smoothed; in levels. */
static bool difference(const FlClip *clip, int frame, const uint8_t paper[3], float *plane,
                       GError **error)
{
    const size_t pixels = (size_t)clip->width * clip->height;
    const uint8_t *rgb = clip->rgb + frame * pixels * 3;
    for (size_t i = 0; i < pixels; i++, rgb += 3) {
        int most = 0;
        for (int c = 0; c < 3; c++)
            most = MAX(most, abs(rgb[c] - paper[c]));
        plane[i] = (float)most;
    }
    return fl_blur_plane(plane, clip->width, clip->height, SMOOTH_PX, error);
}

/*
 * Where paint begins, in levels of difference: Otsu's threshold between the two kinds of pixels of
 * the last frame, which holds the most paint, lowered to a third because thin paint is paint too.
 */
static float choose_threshold(const float *plane, size_t pixels)
{
    uint32_t count[256] = {0};
    double total = 0, below = 0, sum_below = 0, best = -1, between = 0;
    for (size_t i = 0; i < pixels; i++)
        count[CLAMP((int)plane[i], 0, 255)]++;
    for (int i = 0; i < 256; i++)
        total += (double)i * count[i];
    for (int i = 0; i < 255; i++) {
        below += count[i];
        sum_below += (double)i * count[i];
        const double above = (double)pixels - below;
        if (below == 0 || above == 0)
            continue;
        const double gap = sum_below / below - (total - sum_below) / above;
        if (below * above * gap * gap > best) {
            best = below * above * gap * gap;
            between = i + 1;
        }
    }
    return CLAMP((float)between / 3, FAINTEST, BOLDEST);
}

/* Collects into `part` the 4-connected pixels around `start` whose value is `value`, sets them
 * to 2. */
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

/* Visits the parts of `value`; parts under `least` pixels take the other value. Returns the
 * largest. */
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
    if (!fl_blur_plane(plane, width, height, MARGIN_PX, error))
        return false;
    for (size_t i = 0; i < pixels; i++)
        mask[i] = (uint8_t)(255 * CLAMP(0.5f + (plane[i] - MARGIN_CUT) / slope, 0, 1) + 0.5f);
    return true;
}

bool fl_extract_masks(const FlClip *clip, const uint8_t paper[3], uint8_t *mask, GError **error)
{
    const int width = clip->width, height = clip->height;
    const size_t pixels = (size_t)width * height;
    g_autofree float *plane = fl_alloc(pixels, sizeof(float), "a mask", error);
    g_autofree uint8_t *binary = fl_alloc(pixels, 1, "a mask", error);
    g_autofree uint32_t *part = fl_alloc(pixels, sizeof(uint32_t), "a mask", error);
    if (!plane || !binary || !part || !difference(clip, clip->n_frames - 1, paper, plane, error))
        return false;
    const float threshold = choose_threshold(plane, pixels);
    for (int frame = 0; frame < clip->n_frames; frame++) {
        if (!difference(clip, frame, paper, plane, error))
            return false;
        for (size_t i = 0; i < pixels; i++)
            binary[i] = plane[i] > threshold;
        const size_t largest = drop_small_parts(binary, width, height, 1, 0, part);
        drop_small_parts(binary, width, height, 1, (size_t)(KEEP_SHARE * (double)largest), part);
        drop_small_parts(binary, width, height, 0, (size_t)(HOLE_SHARE * (double)largest), part);
        if (!binary_to_coverage(binary, width, height, plane, mask + frame * pixels, error))
            return false;
    }
    return true;
}
