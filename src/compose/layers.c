#include "compose/layers.h"
#include "base/alloc.h"
#include "compose/blend.h"
#include "compose/matte.h"

#include <string.h>

/** What the layers above take of each pixel of the frame. */
typedef struct Above {
    int width, height;
    uint8_t *area;   // the shapes that knock out, 0..255
    uint16_t *paint; // the sum of their paint's alpha, 0..65535
    uint8_t *spread; // a grown shape, if shapes are grown; else NULL
    uint8_t *seen;   // the visible coverage of the layer at hand
} Above;

static void above_clear(Above *above)
{
    free(above->area);
    free(above->paint);
    free(above->spread);
    free(above->seen);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Above, above_clear)

static bool above_init(Above *above, int width, int height, bool spreads, GError **error)
{
    const size_t n = (size_t)width * height;
    *above = (Above){.width = width, .height = height};
    return (above->area = fl_alloc(n, 1, "a matte", error)) &&
           (above->paint = fl_alloc(n, 2, "a matte", error)) &&
           (above->seen = fl_alloc(n, 1, "a matte", error)) &&
           (!spreads || (above->spread = fl_alloc(n, 1, "a matte", error)));
}

static int scaled(int a, int b)
{
    return (a * b + 127) / 255;
}

/**
 * The stored alpha of paint of alpha `paint` in a pixel where `seen` of 255 belongs to it. Its
 * share of the final pixel is paint * seen; `over` leaves it 1 - above->paint of its stored alpha.
 */
static int stored_alpha(int paint, int seen, int covered, int above)
{
    const int left = 65535 - above;
    if (left < 257) // hidden: the whole shape, for those who move the layers apart
        return scaled(paint, covered);
    const int64_t share = (int64_t)paint * seen * 65535 / 255;
    return (int)MIN((share + left / 2) / left, 255);
}

static bool knocks_out(const FlLayer *layer)
{
    return layer->stacking == FL_STACKING_KNOCKOUT && layer->mix == FL_MIX_OVER;
}

static void resolve_rows(const FlLayer *layer, Above *above)
{
    const bool knocks = knocks_out(layer);
    const FlBox box = layer->area.box;
#pragma omp parallel for schedule(static) if (fl_box_pixels(box) > FL_WORTH_THREADS)
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        for (int x = span.first; x < span.last; x++) {
            const size_t i = (size_t)(box.y + y) * above->width + box.x + x;
            const size_t j = (size_t)y * box.width + x;
            const uint8_t coverage = layer->coverage[(size_t)y * layer->pitch + x];
            uint8_t *alpha = layer->rgba + 4 * j + 3;
            if (!coverage) { // as below
                *alpha = 0;
                continue;
            }
            const int paint = scaled(*alpha, layer->alpha);
            *alpha = (uint8_t)stored_alpha(paint, above->seen[j], coverage, above->paint[i]);
            if (knocks) {
                above->paint[i] += (uint16_t)((65535 - above->paint[i]) * *alpha / 255);
                const int body = layer->body ? layer->body[j] : 255;
                above->area[i] += (uint8_t)scaled(above->seen[j], scaled(body, layer->alpha));
            }
        }
    }
}

static void grow_area(const FlLayer *layer, const FlStackParams *params, Above *above)
{
    const size_t n = (size_t)above->width * above->height;
    const FlMatteShape shape = {&layer->area, layer->coverage, layer->pitch};
    fl_matte_spread(&shape, above->width, above->height, params->gap_px, params->feather_px,
                    above->spread);
    for (size_t i = 0; i < n; i++)
        above->area[i] = (uint8_t)MAX(above->area[i], scaled(above->spread[i], layer->alpha));
}

/** Top layer first: what each one shows, and what it takes from those below. */
static void resolve_occlusion(FlLayer *layers, int n, const FlStackParams *params, Above *above)
{
    for (int k = n - 1; k >= 0; k--) {
        const FlLayer *layer = &layers[k];
        const FlMatteShape shape = {&layer->area, layer->coverage, layer->pitch};
        fl_matte_visible(&shape, above->area, above->width, above->height, above->seen);
        resolve_rows(layer, above);
        if (above->spread && knocks_out(layer))
            grow_area(layer, params, above);
    }
}

/** A blended pixel: values times alpha, and 65535 times alpha. */
typedef struct Sum {
    uint32_t x[3], a;
} Sum;

static void sum_over(Sum *sum, const FlScale *scale, const uint8_t *rgba)
{
    const uint32_t alpha = rgba[3];
    for (int c = 0; c < 3; c++)
        sum->x[c] = (uint32_t)scale->value[rgba[c]] * alpha +
                    (uint32_t)(((uint64_t)sum->x[c] * (255 - alpha) + 127) / 255);
    sum->a = 65535 * alpha + (uint32_t)(((uint64_t)sum->a * (255 - alpha) + 127) / 255);
}

#define OPAQUE (65535 * 255) // the alpha of a sum with nothing left to show through

static int32_t sum_value(const Sum *sum, int channel)
{
    if (sum->a == 0)
        return 0;
    if (sum->a == OPAQUE) // as below, without its long division
        return (int32_t)((sum->x[channel] + 127) / 255);
    return (int32_t)MIN(((uint64_t)sum->x[channel] * 65535 + sum->a / 2) / sum->a, 65535);
}

/** Blends the layers' pixels of row y over the sums of that row. */
static void sum_row(const FlLayer *layers, int n, const FlScale *scale, int y, Sum *sums)
{
    for (int k = 0; k < n; k++) {
        const FlBox box = layers[k].area.box;
        if (y < box.y || y >= box.y + box.height)
            continue;
        const uint8_t *row = layers[k].rgba + (size_t)(y - box.y) * box.width * 4;
        const FlColumns span = fl_area_row(&layers[k].area, y - box.y);
        for (int x = span.first; x < span.last; x++)
            if (row[4 * x + 3])
                sum_over(&sums[box.x + x], scale, row + 4 * x);
    }
}

static void sum_backdrop(const FlBackdrop *backdrop, const FlScale *scale, int y, int width,
                         Sum *sums)
{
    memset(sums, 0, (size_t)width * sizeof *sums);
    for (int x = 0; x < width; x++)
        sum_over(&sums[x], scale,
                 backdrop->rgba ? backdrop->rgba + 4 * ((size_t)y * width + x) : backdrop->flat);
}

/** Lays the density of a glaze over what lies below it: the layer's pixel that does so. */
static void glaze_pixel(const Sum *below, const FlScale *scale, const uint8_t *paper, uint8_t *rgba)
{
    uint8_t under[3], target[3], lifted[4];
    for (int c = 0; c < 3; c++) {
        under[c] = fl_scale_level(scale, sum_value(below, c));
        const int32_t p = scale->value[paper[c]], k = scale->value[rgba[c]];
        const int thin = fl_scale_level(scale, p + (int64_t)(k - p) * rgba[3] / 255);
        target[c] = (uint8_t)MIN((under[c] * thin + paper[c] / 2) / MAX(paper[c], 1), 255);
    }
    fl_lift(scale, target, under, 0, lifted);
    memcpy(rgba, lifted, 4);
}

/** Gives a mixed layer's pixel the colour that is right over what lies below it. */
static void mix_pixel(const Sum *below, int drawn, const FlScale *scale, FlMix mix, uint8_t *rgba)
{
    uint8_t under[3];
    for (int c = 0; c < 3; c++)
        under[c] = fl_scale_level(scale, sum_value(below, c));
    fl_mix(mix, under, drawn, rgba);
}

/** A row of the stack, from the paper up to the layer at hand. */
typedef struct Row {
    Sum *sum;
    uint8_t *drawn; // how far the shapes below cover each pixel, 0..255
} Row;

static void add_shape(const FlLayer *layer, FlColumns span, const uint8_t *coverage, uint8_t *drawn)
{
    for (int x = span.first; x < span.last; x++)
        drawn[x] = (uint8_t)(drawn[x] + scaled(255 - drawn[x], scaled(coverage[x], layer->alpha)));
}

/** Bottom layer first: gives glazes and mixed layers the colours for what lies below them. */
static void resolve_colours(FlLayer *layers, int n, int width, int y, const FlStackParams *params,
                            const FlScale *scale, Row below)
{
    const FlBackdrop paper = {.flat = {params->paper[0], params->paper[1], params->paper[2], 255}};
    sum_backdrop(&paper, scale, y, width, below.sum);
    memset(below.drawn, 0, (size_t)width);
    for (int k = 0; k < n; k++) {
        const FlLayer *layer = &layers[k];
        const FlBox box = layer->area.box;
        if (y < box.y || y >= box.y + box.height)
            continue;
        uint8_t *row = layer->rgba + (size_t)(y - box.y) * box.width * 4;
        const FlColumns span = fl_area_row(&layer->area, y - box.y);
        for (int x = span.first; x < span.last; x++) {
            if (layer->mix != FL_MIX_OVER && row[4 * x + 3])
                mix_pixel(&below.sum[box.x + x], below.drawn[box.x + x], scale, layer->mix,
                          row + 4 * x);
            else if (layer->stacking == FL_STACKING_GLAZE && layer->mix == FL_MIX_OVER)
                glaze_pixel(&below.sum[box.x + x], scale, params->paper, row + 4 * x);
        }
        sum_row(layer, 1, scale, y, below.sum);
        add_shape(layer, span, layer->coverage + (size_t)(y - box.y) * layer->pitch,
                  below.drawn + box.x);
    }
}

bool fl_layers_resolve(FlLayer *layers, int n, int width, int height, const FlStackParams *params,
                       GError **error)
{
    g_auto(Above) above = {0};
    if (!above_init(&above, width, height, params->gap_px > 0 || params->feather_px > 0, error))
        return false;
    g_autofree Sum *sums = fl_alloc((size_t)width, sizeof *sums, "a row of pixels", error);
    g_autofree uint8_t *drawn = sums ? fl_alloc((size_t)width, 1, "a row of pixels", error) : NULL;
    if (!drawn)
        return false;
    resolve_occlusion(layers, n, params, &above);
    bool plain = true;
    for (int k = 0; k < n; k++)
        plain &= layers[k].stacking != FL_STACKING_GLAZE && layers[k].mix == FL_MIX_OVER;
    FlScale scale;
    fl_scale_init(&scale, params->linear);
    for (int y = 0; !plain && y < height; y++)
        resolve_colours(layers, n, width, y, params, &scale, (Row){sums, drawn});
    return true;
}

static void store_row(const Sum *sums, const FlScale *scale, int width, uint8_t *out)
{
    for (int x = 0; x < width; x++) {
        for (int c = 0; c < 3; c++)
            out[4 * x + c] = sums[x].a ? fl_scale_level(scale, sum_value(&sums[x], c)) : 0;
        out[4 * x + 3] = (uint8_t)((sums[x].a + 32767) / 65535);
    }
}

static void store_row16(const Sum *sums, const FlScale *scale, int width, uint16_t *out)
{
    for (int x = 0; x < width; x++) {
        for (int c = 0; c < 3; c++)
            out[4 * x + c] = fl_scale_level16(scale, sum_value(&sums[x], c));
        out[4 * x + 3] = (uint16_t)((sums[x].a + 127) / 255);
    }
}

static void compose(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width, int height,
                    bool linear, uint8_t *out, uint16_t *out16)
{
    FlScale scale;
    fl_scale_init(&scale, linear);
#pragma omp parallel
    {
        g_autofree Sum *sums = g_new(Sum, width);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++) {
            sum_backdrop(backdrop, &scale, y, width, sums);
            sum_row(layers, n, &scale, y, sums);
            if (out)
                store_row(sums, &scale, width, out + (size_t)y * width * 4);
            else
                store_row16(sums, &scale, width, out16 + (size_t)y * width * 4);
        }
    }
}

void fl_layers_compose(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width,
                       int height, bool linear, uint8_t *out)
{
    compose(layers, n, backdrop, width, height, linear, out, NULL);
}

void fl_layers_compose16(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width,
                         int height, bool linear, uint16_t *out)
{
    compose(layers, n, backdrop, width, height, linear, NULL, out);
}
