#include "style/recording.h"

#include "base/alloc.h"
#include "base/curves.h"

#include <math.h>
#include <string.h>

enum { REACH = 8, MARGIN = REACH + 2, LEAST_PIXELS = 500, NEWTON_STEPS = 12 };

/* A shift counts if it leaves less than this share of the squared difference from the first frame.
 */
static const double CLEARLY_NEARER = 0.8;

/* The least mean squared slope of usable paper, (levels per px)^2: below it is only noise. */
static const double LEAST_TEXTURE = 0.25;

/* If the shifts of two halves of the paper differ more, px, it is not the camera that moves. */
static const float AGREE_PX = 0.35f;

/* Detail is lightness as a share of its mean over LIGHT_PX of bare paper, times USUAL_LEVELS: a
 * lamp that lights the sheet unevenly, or flickers, makes no detail that a shift could follow. */
static const float LIGHT_PX = 8, USUAL_LEVELS = 200;

/* The light of a frame, a value per pixel. */
typedef struct Light {
    float *bare; // share of the neighbourhood that is bare in every frame, 0..1
    float *mean; // its mean lightness in the current frame
} Light;

static bool mean_over_paper(const FlClip *clip, float *plane, const uint8_t *painted,
                            GError **error)
{
    for (size_t i = 0; i < (size_t)clip->width * clip->height; i++)
        plane[i] = painted[i] ? 0 : plane[i];
    return fl_blur_recording(plane, clip->width, clip->height, LIGHT_PX, error);
}

static bool read_detail(const FlClip *clip, int frame, const uint8_t *painted, const Light *light,
                        float *detail, GError **error)
{
    const size_t pixels = (size_t)clip->width * clip->height;
    const uint8_t *rgb = clip->rgb + frame * pixels * 3;
    for (size_t i = 0; i < pixels; i++, rgb += 3)
        detail[i] = 0.25f * rgb[0] + 0.5f * rgb[1] + 0.25f * rgb[2];
    memcpy(light->mean, detail, pixels * sizeof *detail);
    if (!fl_blur_recording(detail, clip->width, clip->height, 1, error) ||
        !mean_over_paper(clip, light->mean, painted, error))
        return false;
    for (size_t i = 0; i < pixels; i++)
        detail[i] *= USUAL_LEVELS * light->bare[i] / MAX(1, light->mean[i]);
    return true;
}

/* Collects the places that are bare in every frame, 4 px away from paint and MARGIN from the rim.
 */
static size_t find_bare(const FlClip *clip, const uint8_t *mask, uint8_t *painted, uint32_t *place)
{
    enum { AWAY = 4 };
    const int width = clip->width, height = clip->height;
    const size_t pixels = (size_t)width * height;
    for (int frame = 0; frame < clip->n_frames; frame++)
        for (size_t i = 0; i < pixels; i++)
            painted[i] |= mask[frame * pixels + i] > 0;
    size_t n = 0;
    for (int y = MARGIN; y < height - MARGIN; y++)
        for (int x = MARGIN; x < width - MARGIN; x++) {
            const size_t i = (size_t)y * width + x, away = (size_t)AWAY * width;
            if (!painted[i] && !painted[i - AWAY] && !painted[i + AWAY] && !painted[i - away] &&
                !painted[i + away])
                place[n++] = (uint32_t)i;
        }
    return n;
}

static float sample(const float *luma, int width, size_t place, FlShift shift)
{
    const float fx = floorf(shift.x), fy = floorf(shift.y), u = shift.x - fx, v = shift.y - fy;
    const float *p = luma + (ptrdiff_t)place + (ptrdiff_t)fy * width + (ptrdiff_t)fx;
    return (1 - v) * ((1 - u) * p[0] + u * p[1]) + v * ((1 - u) * p[width] + u * p[width + 1]);
}

/* Two frames, and the places where they are compared. */
typedef struct Pair {
    const float *first, *current;
    int width;
    const uint32_t *place; // n of them
    size_t n;
} Pair;

static double squared_difference(const Pair *pair, FlShift shift)
{
    double sum = 0;
    for (size_t i = 0; i < pair->n; i++) {
        const double d =
            sample(pair->current, pair->width, pair->place[i], shift) - pair->first[pair->place[i]];
        sum += d * d;
    }
    return sum;
}

/* The best whole-pixel shift, found by walking downhill from `start`: shake is a smooth motion. */
static FlShift walk(const Pair *pair, FlShift start)
{
    FlShift best = {roundf(start.x), roundf(start.y)};
    double least = squared_difference(pair, best);
    for (bool moved = true; moved;) {
        const FlShift centre = best;
        moved = false;
        for (int k = 0; k < 25; k++) {
            const FlShift next = {centre.x + (float)(k % 5 - 2), centre.y + (float)(k / 5 - 2)};
            if (fabsf(next.x) > REACH || fabsf(next.y) > REACH)
                continue;
            const double d = squared_difference(pair, next);
            if (d < least) {
                least = d;
                best = next;
                moved = true;
            }
        }
    }
    return best;
}

/* Gauss and Newton on the squared difference [Lucas81]. */
static FlShift refine(const Pair *pair, FlShift shift)
{
    const FlShift start = shift;
    for (int step = 0; step < NEWTON_STEPS; step++) {
        double xx = 1e-9, xy = 0, yy = 1e-9, xd = 0, yd = 0;
        for (size_t i = 0; i < pair->n; i++) {
            const size_t p = pair->place[i];
            const double d = sample(pair->current, pair->width, p, shift) - pair->first[p];
            const double gx = 0.5 * (pair->first[p + 1] - pair->first[p - 1]);
            const double gy = 0.5 * (pair->first[p + pair->width] - pair->first[p - pair->width]);
            xx += gx * gx, xy += gx * gy, yy += gy * gy;
            xd += gx * d, yd += gy * d;
        }
        const double determinant = xx * yy - xy * xy;
        if (determinant < 1e-3 * xx * yy) // marks of one direction only
            return start;
        shift.x -= (float)((yy * xd - xy * yd) / determinant);
        shift.y -= (float)((xx * yd - xy * xd) / determinant);
        if (fabsf(shift.x - start.x) > 1.5f || fabsf(shift.y - start.y) > 1.5f)
            return start;
    }
    return shift;
}

/* Sorts the places by a checkerboard of 32 px. Returns: how many lie on its white squares. */
static size_t sort_by_square(uint32_t *place, size_t n, int width)
{
    size_t white = 0;
    for (size_t i = 0; i < n; i++)
        if ((place[i] % width / 32 + place[i] / width / 32) % 2 == 0) {
            const uint32_t swapped = place[white];
            place[white++] = place[i];
            place[i] = swapped;
        }
    return white;
}

static bool has_texture(const Pair *pair)
{
    double sum = 0;
    for (size_t i = 0; i < pair->n; i++) {
        const float *p = pair->first + pair->place[i];
        const double gx = 0.5 * (p[1] - p[-1]), gy = 0.5 * (p[pair->width] - p[-pair->width]);
        sum += gx * gx + gy * gy;
    }
    return pair->n >= LEAST_PIXELS && sum >= LEAST_TEXTURE * (double)pair->n;
}

/* The shift of the current frame, near that of the frame before; zero if uncertain. */
static FlShift find_shift(const Pair *pair, size_t n_white, FlShift before)
{
    const FlShift none = {0, 0};
    Pair white = *pair, black = *pair;
    white.n = n_white;
    black.place += n_white;
    black.n -= n_white;
    const FlShift coarse = walk(pair, before), found = refine(pair, coarse);
    const FlShift a = refine(&white, coarse), b = refine(&black, coarse);
    const bool agree = hypotf(a.x - b.x, a.y - b.y) < AGREE_PX;
    const bool nearer =
        squared_difference(pair, found) < CLEARLY_NEARER * squared_difference(pair, none);
    return agree && nearer ? found : none;
}

bool fl_shake_estimate(const FlClip *clip, const uint8_t *mask, FlShift *shift, GError **error)
{
    const size_t pixels = (size_t)clip->width * clip->height;
    g_autofree float *planes = fl_alloc(4 * pixels, sizeof(float), "a frame", error);
    g_autofree uint32_t *place = fl_alloc(pixels, sizeof(uint32_t), "a frame", error);
    g_autofree uint8_t *painted = fl_alloc(pixels, 1, "a frame", error);
    if (!planes || !place || !painted)
        return false;
    const size_t n = find_bare(clip, mask, painted, place);
    float *first = planes, *current = planes + pixels;
    const Light light = {.bare = planes + 2 * pixels, .mean = planes + 3 * pixels};
    for (size_t i = 0; i < pixels; i++)
        light.bare[i] = 1;
    if (!mean_over_paper(clip, light.bare, painted, error) ||
        !read_detail(clip, 0, painted, &light, first, error))
        return false;
    const size_t n_white = sort_by_square(place, n, clip->width);
    const Pair pair = {first, current, clip->width, place, n};
    memset(shift, 0, clip->n_frames * sizeof *shift);
    const bool possible = has_texture(&pair);
    for (int frame = 1; frame < clip->n_frames && possible; frame++) {
        if (!read_detail(clip, frame, painted, &light, current, error))
            return false;
        shift[frame] = find_shift(&pair, n_white, shift[frame - 1]);
    }
    return true;
}

float fl_shake_extent(const FlShift *shift, int n_frames)
{
    float extent = 0;
    for (int i = 0; i < n_frames; i++)
        extent = MAX(extent, MAX(fabsf(shift[i].x), fabsf(shift[i].y)));
    return extent;
}

bool fl_shake_undo(uint8_t *plane, int width, int height, int channels, FlShift shift,
                   GError **error)
{
    const size_t bytes = (size_t)width * height * channels;
    g_autofree uint8_t *copy = fl_alloc(bytes, 1, "a frame", error);
    if (!copy)
        return false;
    memcpy(copy, plane, bytes);
    const int dx = (int)floorf(shift.x), dy = (int)floorf(shift.y);
    float along[4], down[4];
    fl_cubic_weights(shift.x - (float)dx, along);
    fl_cubic_weights(shift.y - (float)dy, down);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++)
            for (int c = 0; c < channels; c++) {
                float sum = 0;
                for (int k = 0; k < 16; k++) {
                    const int sx = CLAMP(x + dx + k % 4 - 1, 0, width - 1);
                    const int sy = CLAMP(y + dy + k / 4 - 1, 0, height - 1);
                    sum +=
                        along[k % 4] * down[k / 4] * copy[((size_t)sy * width + sx) * channels + c];
                }
                plane[((size_t)y * width + x) * channels + c] =
                    (uint8_t)(CLAMP(sum, 0, 255) + 0.5f);
            }
    return true;
}
