#include "compose/layers.h"
#include "base/alloc.h"
#include "base/schedule.h"
#include "compose/layer_blend.h"
#include "compose/visibility.h"

#include <string.h>

bool fl_layers_above_init(FlLayersAbove *above, int width, int height, const FlStackParams *params,
                          GError **error)
{
    const size_t n = (size_t)width * height;
    *above = (FlLayersAbove){.width = width, .height = height, .params = *params};
    fl_transfer_init(&above->scale, params->linear);
    return (above->area = fl_alloc(n, 1, "a matte", error)) &&
           (above->paint = fl_alloc(n, 2, "a matte", error)) &&
           (above->seen = fl_alloc(n, 1, "a matte", error)) &&
           (params->gap_px <= 0 || (above->spread = fl_alloc(n, 1, "a matte", error)));
}

void fl_layers_above_clear(FlLayersAbove *above)
{
    free(above->area);
    free(above->paint);
    free(above->spread);
    free(above->seen);
}

static int scaled(int a, int b)
{
    return (a * b + 127) / 255;
}

typedef void (*OnColumns)(const FlLayer *layer, const FlLayersAbove *above, int y,
                          FlColumns columns);

/* Does `work` for the columns of each row of a layer in which there is coverage. */
static void each_run(const FlLayer *layer, const FlLayersAbove *above, OnColumns work)
{
    const FlRect box = layer->area.box;
#pragma omp parallel for schedule(static) if (fl_schedule_worth_threads(fl_rect_pixels(box)))
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)box.width;
        for (FlColumns run = fl_next_run(coverage, span.first, span.last); run.first < run.last;
             run = fl_next_run(coverage, run.last, span.last))
            work(layer, above, y, run);
    }
}

static void see_columns(const FlLayer *layer, const FlLayersAbove *above, int y, FlColumns columns)
{
    const FlVisibleShape shape = {&layer->area, layer->coverage};
    fl_visibility_row(&shape, above->area, above->width, above->height, y, columns,
                      above->seen + (size_t)y * (size_t)layer->area.box.width);
}

/**
 * The share of a layer's pixel that stays, 0..255, of which the layers above leave `rest` in sight:
 * what is seen through translucent shapes does; what is seen since their paint is thin does by
 * keep.
 */
static int faded(int rest, int open, int keep)
{
    return rest > open ? (open * 255 + (rest - open) * keep) / rest : 255;
}

/** Fades columns of row y of the layer. */
static void fade_columns(const FlLayer *layer, const FlLayersAbove *above, int y, FlColumns columns)
{
    const FlFade *fade = &layer->fade;
    const FlRect own = layer->area.box, box = fade->box;
    const size_t row = (size_t)(own.y + y - box.y) * (size_t)box.width;
    const uint8_t *area = above->area + (size_t)(own.y + y) * (size_t)above->width + own.x;
    for (int x = columns.first; x < columns.last; x++) {
        const size_t at = row + (size_t)(own.x + x - box.x);
        const size_t p = (size_t)y * (size_t)own.width + (size_t)x;
        if (fade->keep[at] == 255)
            continue;
        const int left = faded(255 - area[x], fade->open[at], fade->keep[at]);
        layer->rgba[4 * p + 3] = (uint8_t)((layer->rgba[4 * p + 3] * left + 127) / 255);
        if (layer->knockout)
            layer->knockout[p] = (uint8_t)((layer->knockout[p] * left + 127) / 255);
    }
}

/** Lowers the opacity of a pixel to a limit; over the paper it keeps its look. */
static void lower_opacity(const FlLayersAbove *above, int limit, uint8_t rgba[4])
{
    uint8_t colour[3];
    for (int c = 0; c < 3; c++) {
        const int32_t paper = above->scale.value[above->params.paper[c]];
        const int32_t excess = above->scale.value[rgba[c]] - paper;
        colour[c] = fl_transfer_level(&above->scale, paper + excess * rgba[3] / 255);
    }
    fl_unblend(&above->scale, colour, above->params.paper, limit, rgba);
}

/**
 * Columns of row y of a layer that yields: it hides no more of the layers below than it knocks out,
 * and below the paint above it needs an alpha of at most 255.
 */
static void yield_columns(const FlLayer *layer, const FlLayersAbove *above, int y,
                          FlColumns columns)
{
    const FlRect box = layer->area.box;
    const uint16_t *paint = above->paint + (size_t)(box.y + y) * (size_t)above->width + box.x;
    const size_t row = (size_t)y * (size_t)box.width;
    for (int x = columns.first; x < columns.last; x++) {
        const size_t p = row + (size_t)x;
        const int left = (65535 - paint[x]) / 257, seen = scaled(above->seen[p], layer->alpha);
        const int limit = MIN(layer->knockout[p], 255 * left / MAX(seen, 1));
        if (layer->rgba[4 * p + 3] > limit && left > 0)
            lower_opacity(above, limit, layer->rgba + 4 * p);
    }
}

/**
 * The stored alpha of paint of alpha `paint`, of which `seen` of 255 is visible in the pixel. Its
 * share of the final pixel is paint * seen; `over` leaves it 1 - above of its stored alpha. Float
 * division suffices: both sides are below 2^24, and quotients of 256 and more do not matter.
 */
static int stored_alpha(int paint, int seen, int covered, int above)
{
    const int left = 65535 - above, share = paint * seen * 257 + left / 2;
    if (left < 257) // hidden: the whole shape, for those who move layers apart in a compositor
        return scaled(paint, covered);
    return (int)MIN((float)share / (float)left, 255);
}

/** Sets the stored alpha of a layer's columns, and adds their paint and their knock-out to what is
 * above the next layers. */
static void resolve_columns(const FlLayer *layer, const FlLayersAbove *above, int y,
                            FlColumns columns)
{
    if (layer->fade.keep)
        fade_columns(layer, above, y, columns);
    if (layer->yields)
        yield_columns(layer, above, y, columns);
    const FlRect box = layer->area.box;
    const size_t row = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
    const bool knocks = fl_layer_knocks_out(layer);
    for (int x = columns.first; x < columns.last; x++) {
        const size_t p = (size_t)y * (size_t)box.width + (size_t)x, i = row + (size_t)x;
        const int covered = layer->coverage[p], seen = above->seen[p];
        const int paint = scaled(layer->rgba[4 * p + 3], layer->alpha);
        const int alpha = covered ? stored_alpha(paint, seen, covered, above->paint[i]) : 0;
        layer->rgba[4 * p + 3] = (uint8_t)alpha;
        if (!knocks)
            continue;
        const int knockout = layer->knockout ? layer->knockout[p] : 255;
        above->paint[i] = (uint16_t)(above->paint[i] + (65535 - above->paint[i]) * alpha / 255);
        above->area[i] = (uint8_t)(above->area[i] + scaled(seen, scaled(knockout, layer->alpha)));
    }
}

static void grow_area(const FlLayer *layer, FlLayersAbove *above)
{
    const size_t n = (size_t)above->width * above->height;
    const FlVisibleShape shape = {&layer->area, layer->coverage};
    fl_visibility_spread(&shape, above->width, above->height, above->params.gap_px, above->spread);
    for (size_t i = 0; i < n; i++)
        above->area[i] = (uint8_t)MAX(above->area[i], scaled(above->spread[i], layer->alpha));
}

void fl_layer_occlude(FlLayer *layer, FlLayersAbove *above)
{
    each_run(layer, above, see_columns); // it looks at rows around its own
    each_run(layer, above, resolve_columns);
    if (above->spread && fl_layer_knocks_out(layer))
        grow_area(layer, above);
}

bool fl_layer_pack(FlLayer *layer, GError **error)
{
    const bool packed = fl_pixel_runs_init(&layer->runs, &layer->area, layer->rgba, error);
    g_clear_pointer(&layer->rgba, free);
    return packed;
}

/** A blended pixel: values times alpha, and 65535 times alpha. */
typedef struct Sum {
    uint32_t x[3], a;
} Sum;

/** A row of them, in planes. */
typedef struct Sums {
    uint32_t *x[3], *a;
} Sums;

static uint32_t over(uint32_t sum, uint32_t value, uint32_t alpha)
{
    return value * alpha + (sum * (255 - alpha) + 127) / 255; // below 2^32, as 65535 * 255^2 is
}

/** A row of sums in 4 * width values. */
static Sums sums_in(uint32_t *values, int width)
{
    return (Sums){{values, values + width, values + 2 * (size_t)width}, values + 3 * (size_t)width};
}

/** A row of sums from column `first` on. */
static Sums sums_from(const Sums *sums, int first)
{
    return (Sums){{sums->x[0] + first, sums->x[1] + first, sums->x[2] + first}, sums->a + first};
}

static void sum_over(const Sums *sums, const FlTransfer *scale, const uint8_t *rgba, int n)
{
    for (int i = 0; i < n; i++) {
        const uint32_t alpha = rgba[4 * i + 3];
        for (int c = 0; c < 3; c++)
            sums->x[c][i] = over(sums->x[c][i], (uint32_t)scale->value[rgba[4 * i + c]], alpha);
        sums->a[i] = over(sums->a[i], 65535, alpha);
    }
}

#define OPAQUE (65535 * 255) // the alpha of a sum through which no lower layer shows

static Sum sum_at(const Sums *sums, int i)
{
    return (Sum){{sums->x[0][i], sums->x[1][i], sums->x[2][i]}, sums->a[i]};
}

static int32_t sum_value(const Sum *sum, int channel)
{
    if (sum->a == 0)
        return 0;
    if (sum->a == OPAQUE) // as below, without its long division
        return (int32_t)((sum->x[channel] + 127) / 255);
    return (int32_t)MIN(((uint64_t)sum->x[channel] * 65535 + sum->a / 2) / sum->a, 65535);
}

/** Blends row y of a packed layer whose box begins at column x. */
static void sum_runs(const FlPixelRuns *runs, const FlTransfer *scale, int y, int x,
                     const Sums *sums)
{
    for (size_t r = runs->first[y]; r < runs->first[y + 1]; r++) {
        const FlPixelRun *run = &runs->run[r];
        const Sums below = sums_from(sums, x + run->columns.first);
        sum_over(&below, scale, runs->rgba + 4 * run->at, run->columns.last - run->columns.first);
    }
}

/** Blends the layers' pixels of row y over the sums of that row. */
static void sum_row(const FlLayer *layers, int n, const FlTransfer *scale, int y, const Sums *sums)
{
    for (int k = 0; k < n; k++) {
        const FlRect box = layers[k].area.box;
        if (y < box.y || y >= box.y + box.height)
            continue;
        if (layers[k].runs.first) {
            sum_runs(&layers[k].runs, scale, y - box.y, box.x, sums);
            continue;
        }
        const uint8_t *row = layers[k].rgba + (size_t)(y - box.y) * box.width * 4;
        const FlColumns span = fl_area_row(&layers[k].area, y - box.y);
        const Sums below = sums_from(sums, box.x + span.first);
        sum_over(&below, scale, row + 4 * span.first, span.last - span.first);
    }
}

static void sum_backdrop(const FlBackdrop *backdrop, const FlTransfer *scale, int y, int width,
                         const Sums *sums)
{
    uint32_t *const planes[4] = {sums->x[0], sums->x[1], sums->x[2], sums->a};
    const int n = backdrop->rgba ? width : 1; // of a flat one the first pixel, and then copies
    for (int k = 0; k < 4; k++)
        memset(planes[k], 0, (size_t)n * sizeof *planes[k]);
    sum_over(sums, scale, backdrop->rgba ? backdrop->rgba + 4 * (size_t)y * width : backdrop->flat,
             n);
    for (int k = 0; k < 4; k++)
        for (int x = n; x < width; x++)
            planes[k][x] = planes[k][0];
}

/** The layer's pixel that adds the density of a glaze to the colour below, where it thins paint
 * that is darker than it would be on paper. */
static void glaze_pixel(const Sum *below, const FlTransfer *scale, const uint8_t *paper,
                        uint8_t lift, uint8_t *rgba)
{
    uint8_t under[3], target[3], lifted[4];
    for (int c = 0; c < 3; c++) {
        under[c] = fl_transfer_level(scale, sum_value(below, c));
        const int32_t p = scale->value[paper[c]], k = scale->value[rgba[c]];
        const int thin = fl_transfer_level(scale, p + (int64_t)(k - p) * rgba[3] / 255);
        const int dense = (under[c] * thin + paper[c] / 2) / MAX(paper[c], 1);
        const int lifted_by = MAX(thin - under[c], 0) * scaled(lift, rgba[3]) / 255;
        target[c] = (uint8_t)MIN(dense + lifted_by, 255);
    }
    fl_unblend(scale, target, under, 0, lifted);
    memcpy(rgba, lifted, 4);
}

/** Gives a pixel of a layer with a blend mode the blended colour over the colour below. */
static void blend_pixel(const Sum *below, int drawn, const FlTransfer *scale,
                        FlBlendMode blend_mode, uint8_t *rgba)
{
    uint8_t under[3];
    for (int c = 0; c < 3; c++)
        under[c] = fl_transfer_level(scale, sum_value(below, c));
    fl_blend_mode_apply(blend_mode, under, drawn, rgba);
}

/** A row of the stack, from the paper up to the layer at hand. */
typedef struct Row {
    Sums sums;
    uint8_t *drawn; // the share of each pixel that the shapes below cover, 0..255
} Row;

static void add_shape(const FlLayer *layer, FlColumns span, const uint8_t *coverage, uint8_t *drawn)
{
    for (int x = span.first; x < span.last; x++)
        drawn[x] = (uint8_t)(drawn[x] + scaled(255 - drawn[x], scaled(coverage[x], layer->alpha)));
}

/** Bottom layer first: gives glazes and layers with a blend mode the colours for what lies below
 * them. */
static void resolve_colours(FlLayer *layers, int n, int width, int y, const FlStackParams *params,
                            const FlTransfer *scale, Row below)
{
    const FlBackdrop paper = {.flat = {params->paper[0], params->paper[1], params->paper[2], 255}};
    sum_backdrop(&paper, scale, y, width, &below.sums);
    memset(below.drawn, 0, (size_t)width);
    for (int k = 0; k < n; k++) {
        const FlLayer *layer = &layers[k];
        const FlRect box = layer->area.box;
        if (y < box.y || y >= box.y + box.height)
            continue;
        uint8_t *row = layer->rgba + (size_t)(y - box.y) * box.width * 4;
        const FlColumns span = fl_area_row(&layer->area, y - box.y);
        for (int x = span.first; x < span.last; x++) {
            const Sum under = sum_at(&below.sums, box.x + x);
            if (layer->blend_mode != FL_BLEND_MODE_OVER && row[4 * x + 3])
                blend_pixel(&under, below.drawn[box.x + x], scale, layer->blend_mode, row + 4 * x);
            else if (layer->stacking == FL_STACKING_GLAZE &&
                     layer->blend_mode == FL_BLEND_MODE_OVER)
                glaze_pixel(&under, scale, params->paper, layer->lift, row + 4 * x);
        }
        sum_row(layer, 1, scale, y, &below.sums);
        add_shape(layer, span, layer->coverage + (size_t)(y - box.y) * box.width,
                  below.drawn + box.x);
    }
}

bool fl_layers_resolve(FlLayer *layers, int n, int width, int height, const FlStackParams *params,
                       GError **error)
{
    g_auto(FlLayersAbove) above = {0};
    if (!fl_layers_above_init(&above, width, height, params, error))
        return false;
    g_autofree uint32_t *sums = fl_alloc(4 * (size_t)width, sizeof *sums, "a row", error);
    g_autofree uint8_t *drawn = sums ? fl_alloc((size_t)width, 1, "a row of pixels", error) : NULL;
    if (!drawn)
        return false;
    for (int k = n - 1; k >= 0; k--)
        fl_layer_occlude(&layers[k], &above);
    bool plain = true;
    for (int k = 0; k < n; k++)
        plain &=
            layers[k].stacking != FL_STACKING_GLAZE && layers[k].blend_mode == FL_BLEND_MODE_OVER;
    for (int y = 0; !plain && y < height; y++)
        resolve_colours(layers, n, width, y, params, &above.scale,
                        (Row){sums_in(sums, width), drawn});
    return true;
}

static void store_row(const Sums *sums, const FlTransfer *scale, int width, uint8_t *out)
{
    for (int x = 0; x < width; x++) {
        const Sum sum = sum_at(sums, x);
        for (int c = 0; c < 3; c++)
            out[4 * x + c] = sum.a ? fl_transfer_level(scale, sum_value(&sum, c)) : 0;
        out[4 * x + 3] = (uint8_t)((sum.a + 32767) / 65535);
    }
}

static void store_row16(const Sums *sums, const FlTransfer *scale, int width, uint16_t *out)
{
    for (int x = 0; x < width; x++) {
        const Sum sum = sum_at(sums, x);
        for (int c = 0; c < 3; c++)
            out[4 * x + c] = fl_transfer_level16(scale, sum_value(&sum, c));
        out[4 * x + 3] = (uint16_t)((sum.a + 127) / 255);
    }
}

static void compose(const FlLayer *layers, int n, const FlBackdrop *backdrop, int width, int height,
                    bool linear, uint8_t *out, uint16_t *out16)
{
    FlTransfer scale;
    fl_transfer_init(&scale, linear);
#pragma omp parallel
    {
        g_autofree uint32_t *values = g_new(uint32_t, 4 * (size_t)width);
        const Sums sums = sums_in(values, width);
#pragma omp for schedule(static)
        for (int y = 0; y < height; y++) {
            sum_backdrop(backdrop, &scale, y, width, &sums);
            sum_row(layers, n, &scale, y, &sums);
            if (out)
                store_row(&sums, &scale, width, out + (size_t)y * width * 4);
            else
                store_row16(&sums, &scale, width, out16 + (size_t)y * width * 4);
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
