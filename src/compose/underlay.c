#include "compose/underlay.h"

#include "base/alloc.h"
#include "base/schedule.h"
#include <string.h>

#define SHOWN 128 // coverage from which on a shape is there
#define MARGIN_PX 4
#define SIDE 5 // a step of the distances, and one to a corner
#define CORNER 7
#define FAR 30000
#define BESIDE_PX 3 // a sliver farther from what lies above is a shape of its own
#define BESIDE_HALF_PX 2

void fl_fading_clear(FlFading *fading)
{
    free(fading->over);
    free(fading->seen);
    *fading = (FlFading){0};
}

static bool fading_init(FlFading *fading, const FlLayer *layer, const FlUnderlay *above,
                        GError **error)
{
    const FlRect page = {0, 0, above->width, above->height};
    fading->box = fl_rect_grown(layer->area.box, MARGIN_PX, page);
    fading->half = above->half;
    const size_t n = fl_rect_pixels(fading->box);
    return (fading->over = fl_alloc_unset(n, 1, "a matte", error)) &&
           (fading->seen = fl_alloc_unset(n, 1, "a matte", error));
}

/** Distances of the pixels of a fading's box, fifths of a px. */
typedef struct Ways {
    int16_t *to_open; // to what nothing above covers
    int16_t *to_seen; // to where the layer is seen
} Ways;

static void ways_clear(Ways *ways)
{
    free(ways->to_open);
    free(ways->to_seen);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Ways, ways_clear)

static bool ways_init(Ways *ways, size_t n, GError **error)
{
    return (ways->to_open = fl_alloc_unset(n, sizeof *ways->to_open, "a matte", error)) &&
           (ways->to_seen = fl_alloc_unset(n, sizeof *ways->to_seen, "a matte", error));
}

/** Distances along a row from its pixels that are 0; others come in as FAR. */
static void measure_row(int16_t *row, int width)
{
    for (int x = 0, end; x < width; x = end) {
        end = fl_end_of_same((const uint16_t *)row, x, width);
        if (row[x] == 0)
            continue;
        const int from_left = x > 0 ? SIDE : FAR, from_right = end < width ? SIDE : FAR;
        const int n = end - x;
        for (int k = 0; k < n; k++) {
            const int near = MIN(from_left + k * SIDE, from_right + (n - 1 - k) * SIDE);
            row[x + k] = (int16_t)MIN(near, FAR);
        }
    }
}

static int16_t least(int16_t a, int16_t b)
{
    return MIN(a, b);
}

/** Lowers a row's distances to what those of the row before or after it tell. */
static void lower_from(const int16_t *beside, int16_t *restrict row, int width)
{
    for (int x = 0; x < width; x++)
        row[x] = least(row[x], (int16_t)(beside[x] + SIDE));
    for (int x = 1; x < width - 1; x++)
        row[x] = least(row[x], (int16_t)(least(beside[x - 1], beside[x + 1]) + CORNER));
    if (width > 1) {
        row[0] = least(row[0], (int16_t)(beside[1] + CORNER));
        row[width - 1] = least(row[width - 1], (int16_t)(beside[width - 2] + CORNER));
    }
}

/** Rows of a plane, last exclusive. */
typedef struct Lines {
    int first, last;
} Lines;

/**
 * Distances of some rows from the pixels that are 0; others come in as FAR. The steps of a shortest
 * way may come in any order: those along a row first, so that from row to row no pixel waits for
 * its neighbour.
 */
static void measure(int16_t *plane, int width, int height, Lines wanted)
{
    for (int y = 0; y < height; y++)
        measure_row(plane + (size_t)y * (size_t)width, width);
    for (int y = 1; y < wanted.last; y++)
        lower_from(plane + (size_t)(y - 1) * (size_t)width, plane + (size_t)y * (size_t)width,
                   width);
    for (int y = height - 2; y >= wanted.first; y--)
        lower_from(plane + (size_t)(y + 1) * (size_t)width, plane + (size_t)y * (size_t)width,
                   width);
}

/** Whether anything lies over the layer's shape. */
static bool is_below(const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box;
    uint8_t any = 0;
    for (int y = 0; y < own.height && !any; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const uint8_t *over = above->coverage + (size_t)(own.y + y) * (size_t)above->width + own.x;
        for (int x = span.first; x < span.last; x++)
            any |= MIN(coverage[x], over[x]);
    }
    return any;
}

/** Fills over and seen. */
static void mark_pixels(FlFading *fading, const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box, box = fading->box;
    memset(fading->seen, 0, fl_rect_pixels(box));
    for (int y = 0; y < box.height; y++) {
        uint8_t *restrict over = fading->over + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
        const uint8_t *coverage = above->coverage + i, *hides = above->hides + i;
        for (int x = 0; x < box.width; x++)
            over[x] = hides[x] & (coverage[x] >= SHOWN ? 255 : 0);
    }
    for (int y = 0; y < own.height; y++) {
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const size_t p = (size_t)(own.y + y - box.y) * (size_t)box.width + (size_t)(own.x - box.x);
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *over = fading->over + p;
        const uint8_t *covered =
            above->coverage + (size_t)(own.y + y) * (size_t)above->width + (size_t)own.x;
        uint8_t *restrict seen = fading->seen + p;
        for (int x = span.first; x < span.last; x++) {
            const int most = fading->half ? coverage[x] - covered[x] : coverage[x];
            seen[x] = (most >= SHOWN) & (over[x] == 0);
        }
    }
}

/** Marks blocks of 2x2 pixels, of two rows, in which the layer is seen: by their left columns. */
static void mark_blocks(const uint8_t *seen, const uint8_t *below, int width, uint8_t *block)
{
    for (int x = 0; x + 1 < width; x++)
        block[x] = seen[x] & seen[x + 1] & below[x] & below[x + 1];
}

/** Clears the distances of the pixels of a row that blocks hold. */
static void clear_blocks(const uint8_t *block, int width, int16_t *restrict row)
{
    for (int x = 0; x + 1 < width; x++)
        row[x] = block[x] ? 0 : row[x];
    for (int x = 1; x < width; x++)
        row[x] = block[x - 1] ? 0 : row[x];
}

/** Clears the distances of the pixels of blocks of 2x2 in which the layer is seen. */
static void clear_seen(const FlFading *fading, int16_t *to_seen)
{
    const int w = fading->box.width, h = fading->box.height;
    g_autofree uint8_t *block = g_malloc((size_t)w);
    for (int y = 0; y + 1 < h; y++) {
        const size_t p = (size_t)y * (size_t)w, q = p + (size_t)w;
        mark_blocks(fading->seen + p, fading->seen + q, w, block);
        clear_blocks(block, w, to_seen + p);
        clear_blocks(block, w, to_seen + q);
    }
}

static void find_ways_out(const FlFading *fading, Lines wanted, int16_t *to_open)
{
    const int w = fading->box.width, h = fading->box.height;
    for (size_t p = 0; p < (size_t)w * (size_t)h; p++)
        to_open[p] = fading->over[p] ? FAR : 0;
    measure(to_open, w, h, wanted);
}

/** Distances to where more of the layer is seen than a sliver. */
static void find_ways_to_seen(const FlFading *fading, Lines wanted, int16_t *to_seen)
{
    const int w = fading->box.width, h = fading->box.height;
    const uint8_t is_block = fading->half; // will be one of 2x2
    for (size_t p = 0; p < (size_t)w * (size_t)h; p++)
        to_seen[p] = is_block & fading->seen[p] ? 0 : FAR;
    if (!is_block)
        clear_seen(fading, to_seen);
    measure(to_seen, w, h, wanted);
}

/** Raises each of n values to the one that comes `reach` later, if that is more. */
static void raise_by(uint8_t *value, int n, int reach)
{
    for (int x = 0; x < n; x++)
        value[x] = MAX(value[x], value[x + reach]);
}

static int beside_px(const FlFading *fading)
{
    return fading->half ? BESIDE_HALF_PX : BESIDE_PX;
}

/**
 * How far what is above hides each pixel of a row, or where nothing is, at most within beside_px().
 * hides has twice that more than the row.
 */
static void find_hides(const FlFading *fading, int y, uint8_t *hides)
{
    const int beside = beside_px(fading), window = 2 * beside + 1;
    const int width = fading->box.width, padded = width + 2 * beside;
    const int last = MIN(y + beside, fading->box.height - 1);
    memset(hides, 0, (size_t)padded);
    for (int ny = MAX(y - beside, 0); ny <= last; ny++) {
        const uint8_t *over = fading->over + (size_t)ny * (size_t)width;
        uint8_t *restrict own = hides + beside;
        for (int x = 0; x < width; x++)
            own[x] = MAX(own[x], over[x]);
    }
    int size = 1; // of the windows that hides are of
    for (int left = padded; 2 * size <= window; size *= 2)
        raise_by(hides, left -= size, size);
    raise_by(hides, width, window - size);
    const uint8_t *over = fading->over + (size_t)y * (size_t)width;
    for (int x = 0; x < width; x++)
        hides[x] = over[x] ? over[x] : hides[x];
}

/** How much of the layer stays, 0..255: (2.5 out + 6 - to) / (out + 4), in pixels, where what is
 * above hides all. */
static int kept_at(const FlFading *fading, const Ways *ways, size_t p, int hides)
{
    const int px = fading->half ? 2 : 1;
    const int out = px * ways->to_open[p], to = px * ways->to_seen[p];
    const int share = 5 * out + 12 * SIDE - 2 * to, whole = 2 * (out + 4 * SIDE);
    if (share >= whole) // nearly everywhere: without the division
        return 255;
    const int keep = 255 * share / whole;
    return 255 - ((255 - MAX(keep, 0)) * hides + 127) / 255;
}

/** Row y of the layer; hides is of the pixels of its box. */
static void fade_row(const FlFading *fading, const Ways *ways, FlLayer *layer, int y,
                     const uint8_t *hides)
{
    const FlRect own = layer->area.box;
    const FlColumns span = fl_area_row(&layer->area, y);
    const size_t row = (size_t)y * (size_t)own.width;
    const size_t in_box = (size_t)(own.y + y - fading->box.y) * (size_t)fading->box.width +
                          (size_t)(own.x - fading->box.x);
    for (FlColumns run = fl_next_run(hides, span.first, span.last); run.first < run.last;
         run = fl_next_run(hides, run.last, span.last))
        for (int x = run.first; x < run.last; x++) {
            const size_t p = row + (size_t)x;
            const int keep = kept_at(fading, ways, in_box + (size_t)x, hides[x]);
            if (keep == 255)
                continue;
            layer->rgba[4 * p + 3] = (uint8_t)((layer->rgba[4 * p + 3] * keep + 127) / 255);
            layer->knockout[p] = (uint8_t)((layer->knockout[p] * keep + 127) / 255);
        }
}

/*
 * What is translucent shows what lies below it, which must not fade then; what nearly hides it may
 * take a little. From seven eighths of opacity on, so that at most 1/32 of a pixel's colour goes.
 */
static int hiding(int alpha)
{
    return MAX(8 * alpha - 7 * 255, 0);
}

static void add_above(const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect box = layer->area.box;
    const int hiding_here = hiding(layer->alpha);
    for (int y = 0; y < box.height && hiding_here > 0; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
        uint8_t *restrict most = above->coverage + i, *restrict hides = above->hides + i;
        for (int x = span.first; x < span.last; x++) {
            const uint8_t here = (uint8_t)(coverage[x] >= SHOWN ? hiding_here : 0);
            most[x] = MAX(most[x], coverage[x]);
            hides[x] = MAX(hides[x], here);
        }
    }
}

bool fl_underlay_init(FlUnderlay *above, int width, int height, bool half, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *above = (FlUnderlay){.width = width, .height = height, .half = half};
    return (above->coverage = fl_alloc(pixels, 1, "a matte", error)) &&
           (above->hides = fl_alloc(pixels, 1, "a matte", error));
}

void fl_underlay_clear(FlUnderlay *above)
{
    free(above->coverage);
    free(above->hides);
}

bool fl_underlay_next(FlUnderlay *above, const FlLayer *layer, bool painted, FlFading *fading,
                      GError **error)
{
    const bool knocks = fl_layer_knocks_out(layer);
    *fading = (FlFading){0};
    if (painted && knocks && is_below(layer, above)) {
        if (!fading_init(fading, layer, above, error))
            return false;
        mark_pixels(fading, layer, above);
    }
    if (knocks && !layer->sheer)
        add_above(layer, above);
    return true;
}

/** The rows of a fading in which there is some of the layer. */
static Lines lines_of(const FlFading *fading, const FlLayer *layer)
{
    const int above = layer->area.box.y - fading->box.y;
    Lines lines = {fading->box.height, 0};
    for (int y = 0; y < layer->area.box.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        if (span.first < span.last)
            lines = (Lines){MIN(lines.first, above + y), above + y + 1};
    }
    return lines;
}

bool fl_fading_apply(const FlFading *fading, FlLayer *layer, GError **error)
{
    g_auto(Ways) ways = {0};
    if (!fading->over)
        return true;
    if (!ways_init(&ways, fl_rect_pixels(fading->box), error))
        return false;
    const FlRect own = layer->area.box;
    const Lines wanted = lines_of(fading, layer);
#pragma omp parallel sections if (fl_schedule_worth_threads(fl_rect_pixels(own)))
    {
        find_ways_out(fading, wanted, ways.to_open);
#pragma omp section
        find_ways_to_seen(fading, wanted, ways.to_seen);
    }
#pragma omp parallel if (fl_schedule_worth_threads(fl_rect_pixels(own)))
    {
        g_autofree uint8_t *hides = g_malloc((size_t)(fading->box.width + 2 * beside_px(fading)));
#pragma omp for schedule(static)
        for (int y = 0; y < own.height; y++) {
            const FlColumns span = fl_area_row(&layer->area, y);
            if (span.first == span.last)
                continue;
            find_hides(fading, own.y + y - fading->box.y, hides);
            fade_row(fading, &ways, layer, y, hides + (own.x - fading->box.x));
        }
    }
    return true;
}
