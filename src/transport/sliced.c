#include "transport/sliced.h"

#include "base/alloc.h"
#include "base/rng.h"
#include <math.h>
#include <string.h>

#define PATCH_PIXELS (FL_SLICED_PATCH * FL_SLICED_PATCH)
#define QUANTILES 4096
#define MOST_PLACES 16384 // of the style's patches that are looked at on a level
#define FEWEST_PLACES 64

struct FlSliced {
    float direction[FL_SLICED_DIRECTIONS][PATCH_PIXELS]; // of length 1
    float (*quantile[FL_SLICED_LEVELS])[QUANTILES];      // by direction; NULL: too few patches
};

/* Normal, but for its tails: the sum of twelve uniform numbers. */
static float normal(FlRng *rng)
{
    float sum = -6;
    for (int k = 0; k < 12; k++)
        sum += fl_rng_float(rng);
    return sum;
}

static void make_directions(FlSliced *sliced)
{
    FlRng rng = {fl_key(0x736c696365, 1)};
    for (int d = 0; d < FL_SLICED_DIRECTIONS; d++) {
        float sum = 0;
        for (int i = 0; i < PATCH_PIXELS; i++) {
            sliced->direction[d][i] = normal(&rng);
            sum += sliced->direction[d][i] * sliced->direction[d][i];
        }
        const float length = sqrtf(sum);
        for (int i = 0; i < PATCH_PIXELS; i++)
            sliced->direction[d][i] /= length;
    }
}

/* ---- pyramid -----------------------------------------------------------------------------------
 */

static const float binomial[5] = {1 / 16.f, 4 / 16.f, 6 / 16.f, 4 / 16.f, 1 / 16.f};

/* Blurs and keeps the even pixels; the sides meet. */
static void reduce(const float *in, int width, int height, float *half, float *out)
{
    const int w = width / 2, h = height / 2;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < w; x++) {
            float sum = 0;
            for (int k = 0; k < 5; k++)
                sum +=
                    binomial[k] * in[(size_t)y * width + (size_t)((2 * x + k - 2 + width) % width)];
            half[(size_t)y * w + x] = sum;
        }
    for (int y = 0; y < h; y++)
        for (int x = 0; x < w; x++) {
            float sum = 0;
            for (int k = 0; k < 5; k++)
                sum += binomial[k] * half[(size_t)((2 * y + k - 2 + height) % height) * w + x];
            out[(size_t)y * w + x] = sum;
        }
}

/* The adjoint of reduce(): adds to what `out`, width * height, holds. */
static void reduce_adjoint(const float *in, int width, int height, float *half, float *out)
{
    const int w = width / 2, h = height / 2;
    memset(half, 0, sizeof(float) * (size_t)w * height);
    for (int y = 0; y < h; y++)
        for (int k = 0; k < 5; k++)
            for (int x = 0; x < w; x++)
                half[(size_t)((2 * y + k - 2 + height) % height) * w + x] +=
                    binomial[k] * in[(size_t)y * w + x];
    for (int y = 0; y < height; y++)
        for (int x = 0; x < w; x++)
            for (int k = 0; k < 5; k++)
                out[(size_t)y * width + (size_t)((2 * x + k - 2 + width) % width)] +=
                    binomial[k] * half[(size_t)y * w + x];
}

typedef struct Pyramid {
    int width[FL_SLICED_LEVELS], height[FL_SLICED_LEVELS];
    float *plane[FL_SLICED_LEVELS];
    float *half; // scratch
} Pyramid;

static void pyramid_clear(Pyramid *pyramid)
{
    for (int l = 0; l < FL_SLICED_LEVELS; l++)
        free(pyramid->plane[l]);
    free(pyramid->half);
    *pyramid = (Pyramid){0};
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Pyramid, pyramid_clear)

static bool pyramid_init(Pyramid *pyramid, int width, int height, GError **error)
{
    *pyramid = (Pyramid){0};
    for (int l = 0; l < FL_SLICED_LEVELS; l++) {
        pyramid->width[l] = width >> l, pyramid->height[l] = height >> l;
        const size_t n = (size_t)(width >> l) * (size_t)(height >> l);
        if (!(pyramid->plane[l] = fl_alloc(n, sizeof(float), "a pyramid", error)))
            return false;
    }
    return (pyramid->half = fl_alloc((size_t)width * height, sizeof(float), "a pyramid", error));
}

static void fill_pyramid(Pyramid *pyramid, const float *from)
{
    memcpy(pyramid->plane[0], from, sizeof(float) * (size_t)pyramid->width[0] * pyramid->height[0]);
    for (int l = 1; l < FL_SLICED_LEVELS; l++)
        reduce(pyramid->plane[l - 1], pyramid->width[l - 1], pyramid->height[l - 1], pyramid->half,
               pyramid->plane[l]);
}

/* ---- patches -----------------------------------------------------------------------------------
 */

/* The pixels of a patch in a plane whose sides meet. */
static void read_patch(const float *plane, int width, int height, uint32_t place, float *patch)
{
    const int x0 = (int)(place % (uint32_t)width), y0 = (int)(place / (uint32_t)width);
    for (int y = 0; y < FL_SLICED_PATCH; y++) {
        const float *row = plane + (size_t)((y0 + y) % height) * width;
        for (int x = 0; x < FL_SLICED_PATCH; x++)
            *patch++ = row[(x0 + x) % width];
    }
}

static void add_patch(float *plane, int width, int height, uint32_t place, const float *patch)
{
    const int x0 = (int)(place % (uint32_t)width), y0 = (int)(place / (uint32_t)width);
    for (int y = 0; y < FL_SLICED_PATCH; y++) {
        float *row = plane + (size_t)((y0 + y) % height) * width;
        for (int x = 0; x < FL_SLICED_PATCH; x++)
            row[(x0 + x) % width] += *patch++;
    }
}

/* A number in order: of equal responses the first place comes first. */
typedef struct Ranked {
    uint32_t key; // orders as the response does
    uint32_t index;
} Ranked;

static inline uint32_t ordered(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

/* By three rounds of eleven bits. */
static void sort_ranked(Ranked *items, Ranked *scratch, size_t n)
{
    for (int round = 0; round < 3; round++) {
        const int shift = 11 * round;
        size_t count[2049] = {0};
        for (size_t i = 0; i < n; i++)
            count[((items[i].key >> shift) & 2047) + 1]++;
        for (int b = 0; b < 2048; b++)
            count[b + 1] += count[b];
        for (size_t i = 0; i < n; i++)
            scratch[count[(items[i].key >> shift) & 2047]++] = items[i];
        Ranked *swap = items;
        items = scratch, scratch = swap;
    }
    memcpy(scratch, items, n * sizeof *items); // the third round ended in the scratch
}

static float response(const float *direction, const float *patch)
{
    float sum = 0;
    for (int i = 0; i < PATCH_PIXELS; i++)
        sum += direction[i] * patch[i];
    return sum;
}

/* ---- style -------------------------------------------------------------------------------------
 */

static bool learn_level(FlSliced *sliced, int l, const float *plane, int width, int height,
                        GError **error)
{
    const int across = width - FL_SLICED_PATCH + 1, down = height - FL_SLICED_PATCH + 1;
    const size_t all = across > 0 && down > 0 ? (size_t)across * down : 0;
    const size_t n = MIN(all, MOST_PLACES);
    if (n < FEWEST_PLACES)
        return true;
    g_autofree float *patches = fl_alloc(n * PATCH_PIXELS, sizeof(float), "patches", error);
    g_autofree Ranked *ranked = fl_alloc(2 * n, sizeof *ranked, "patches", error);
    sliced->quantile[l] = fl_alloc(FL_SLICED_DIRECTIONS, sizeof *sliced->quantile[l],
                                   "the patches of a style", error);
    if (!patches || !ranked || !sliced->quantile[l])
        return false;
    for (size_t i = 0; i < n; i++) {
        const uint64_t place = i * all / n;
        read_patch(
            plane, width, height,
            (uint32_t)(place / (uint64_t)across * (uint64_t)width + place % (uint64_t)across),
            patches + i * PATCH_PIXELS);
    }
    g_autofree float *values = g_new(float, n);
    for (int d = 0; d < FL_SLICED_DIRECTIONS; d++) {
        for (size_t i = 0; i < n; i++) {
            values[i] = response(sliced->direction[d], patches + i * PATCH_PIXELS);
            ranked[i] = (Ranked){ordered(values[i]), (uint32_t)i};
        }
        sort_ranked(ranked, ranked + n, n);
        for (size_t q = 0; q < QUANTILES; q++)
            sliced->quantile[l][d][q] = values[ranked[(2 * q + 1) * n / (2 * QUANTILES)].index];
    }
    return true;
}

FlSliced *fl_sliced_new(const float *density, int width, int height, GError **error)
{
    const int grid = 1 << (FL_SLICED_LEVELS - 1), w = width / grid * grid, h = height / grid * grid;
    if (w < 32 || h < 32) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                    "the picture is %dx%d px; expected at least 32x32", width, height);
        return NULL;
    }
    g_autoptr(FlSliced) sliced = g_new0(FlSliced, 1);
    g_auto(Pyramid) pyramid = {0};
    g_autofree float *cut = fl_alloc((size_t)w * h, sizeof(float), "a picture", error);
    if (!cut || !pyramid_init(&pyramid, w, h, error))
        return NULL;
    for (int y = 0; y < h; y++)
        memcpy(cut + (size_t)y * w, density + (size_t)y * width, (size_t)w * sizeof *cut);
    make_directions(sliced);
    fill_pyramid(&pyramid, cut);
    for (int l = 0; l < FL_SLICED_LEVELS; l++)
        if (!learn_level(sliced, l, pyramid.plane[l], pyramid.width[l], pyramid.height[l], error))
            return NULL;
    return g_steal_pointer(&sliced);
}

void fl_sliced_free(FlSliced *sliced)
{
    if (!sliced)
        return;
    for (int l = 0; l < FL_SLICED_LEVELS; l++)
        free(sliced->quantile[l]);
    g_free(sliced);
}

/* ---- loss --------------------------------------------------------------------------------------
 */

/* A level's sampled patches, and what is found for them. */
typedef struct Sample {
    size_t n;
    uint32_t *place;
    float *patch, *by_patch; // n * PATCH_PIXELS
    float *value;
    Ranked *ranked; // 2 n
} Sample;

static void sample_clear(Sample *sample)
{
    g_free(sample->place);
    free(sample->patch);
    free(sample->by_patch);
    free(sample->value);
    free(sample->ranked);
}
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Sample, sample_clear)

static bool sample_init(Sample *sample, size_t n, GError **error)
{
    *sample = (Sample){.n = n};
    sample->place = g_new(uint32_t, n);
    return (sample->patch = fl_alloc(n * PATCH_PIXELS, sizeof(float), "patches", error)) &&
           (sample->by_patch = fl_alloc(n * PATCH_PIXELS, sizeof(float), "patches", error)) &&
           (sample->value = fl_alloc(n, sizeof(float), "patches", error)) &&
           (sample->ranked = fl_alloc(2 * n, sizeof(Ranked), "patches", error));
}

/* The squared distance in one direction, summed; its derivative is added to by_patch. */
static float one_direction(Sample *sample, const float *direction, const float *quantile)
{
    const size_t n = sample->n;
    for (size_t i = 0; i < n; i++) {
        sample->value[i] = response(direction, sample->patch + i * PATCH_PIXELS);
        sample->ranked[i] = (Ranked){ordered(sample->value[i]), (uint32_t)i};
    }
    sort_ranked(sample->ranked, sample->ranked + n, n);
    double sum = 0;
    for (size_t rank = 0; rank < n; rank++) {
        const size_t i = sample->ranked[rank].index;
        const float off = sample->value[i] - quantile[(2 * rank + 1) * QUANTILES / (2 * n)];
        float *by = sample->by_patch + i * PATCH_PIXELS;
        sum += (double)off * off;
        for (int k = 0; k < PATCH_PIXELS; k++)
            by[k] += 2 * off * direction[k];
    }
    return (float)sum;
}

/* The loss of one level; its derivative is added to by_plane. */
static float level_loss(const FlSliced *sliced, int l, const float *plane, int width, int height,
                        int samples, int directions, uint64_t key, float *by_plane, GError **error)
{
    g_auto(Sample) sample = {0};
    if (!sample_init(&sample, (size_t)samples, error))
        return -1;
    FlRng rng = {key};
    for (size_t i = 0; i < sample.n; i++) {
        sample.place[i] = fl_rng_below(&rng, (uint32_t)(width * height));
        read_patch(plane, width, height, sample.place[i], sample.patch + i * PATCH_PIXELS);
    }
    float loss = 0;
    const int first = (int)fl_rng_below(&rng, FL_SLICED_DIRECTIONS);
    const int step = directions < FL_SLICED_DIRECTIONS ? 5 : 1; // prime to their number
    for (int k = 0; k < directions; k++) {
        const int d = (first + k * step) % FL_SLICED_DIRECTIONS;
        loss += one_direction(&sample, sliced->direction[d], sliced->quantile[l][d]);
    }
    const float share = 1 / ((float)directions * (float)samples);
    for (size_t i = 0; by_plane && i < sample.n; i++) {
        float *by = sample.by_patch + i * PATCH_PIXELS;
        for (int k = 0; k < PATCH_PIXELS; k++)
            by[k] *= share;
        add_patch(by_plane, width, height, sample.place[i], by);
    }
    return loss * share;
}

float fl_sliced_loss(const FlSliced *sliced, const float *density, int width, int height,
                     unsigned levels, int samples, int directions, uint64_t key, float *by_density,
                     GError **error)
{
    g_auto(Pyramid) of = {0}, by = {0};
    if (!pyramid_init(&of, width, height, error) || !pyramid_init(&by, width, height, error))
        return -1;
    fill_pyramid(&of, density);
    float total = 0;
    for (int l = FL_SLICED_LEVELS - 1; l >= 0; l--) {
        const int w = of.width[l], h = of.height[l];
        float loss = 0;
        if (l + 1 < FL_SLICED_LEVELS)
            reduce_adjoint(by.plane[l + 1], w, h, by.half, by.plane[l]);
        if (levels >> l & 1 && sliced->quantile[l] && w * h >= FEWEST_PLACES)
            loss = level_loss(sliced, l, of.plane[l], w, h, samples, directions,
                              fl_key(key, (uint64_t)l), by.plane[l], error);
        if (loss < 0)
            return -1;
        total += loss;
    }
    if (by_density)
        memcpy(by_density, by.plane[0], sizeof(float) * (size_t)width * (size_t)height);
    return total;
}
