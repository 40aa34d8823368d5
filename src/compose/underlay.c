#include "compose/underlay.h"

#include "base/alloc.h"
#include <string.h>

#define SHOWN 128 // coverage from which on a shape is there
#define MARGIN_PX 4
#define SIDE 5 // a step of the distances, and one to a corner
#define CORNER 7
#define FAR 30000
#define BESIDE_PX 3 // a sliver farther from what lies above is a shape of its own

/** A layer's box with some room, and what is known of it. */
typedef struct Part {
    FlRect box;
    uint8_t *over;    // how far what covers the pixel from above hides, 0..255; 0: nothing does
    uint8_t *seen;    // 1: the layer is seen
    int16_t *to_open; // distances, fifths of a px: to what nothing above covers
    int16_t *to_seen; // to where the layer is seen
} Part;

static void part_clear(Part *part)
{
    free(part->over);
    free(part->seen);
    free(part->to_open);
    free(part->to_seen);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Part, part_clear)

static bool part_init(Part *part, const FlLayer *layer, int width, int height, GError **error)
{
    const FlRect page = {0, 0, width, height};
    *part = (Part){.box = fl_rect_grown(layer->area.box, MARGIN_PX, page)};
    const size_t n = fl_rect_pixels(part->box);
    return (part->over = fl_alloc_unset(n, 1, "a matte", error)) &&
           (part->seen = fl_alloc_unset(n, 1, "a matte", error)) &&
           (part->to_open = fl_alloc_unset(n, sizeof *part->to_open, "a matte", error)) &&
           (part->to_seen = fl_alloc_unset(n, sizeof *part->to_seen, "a matte", error));
}

/** The first column from x on with another value than that of x. */
static int end_of_run(const int16_t *row, int x, int width)
{
    const int16_t value[4] = {row[x], row[x], row[x], row[x]};
    while (x + 4 <= width && memcmp(row + x, value, sizeof value) == 0)
        x += 4;
    while (x < width && row[x] == value[0])
        x++;
    return x;
}

/** Distances along a row from its pixels that are 0; others come in as FAR. */
static void measure_row(int16_t *row, int width)
{
    for (int x = 0, end; x < width; x = end) {
        end = end_of_run(row, x, width);
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
    for (int x = 1; x < width; x++)
        row[x] = least(row[x], (int16_t)(beside[x - 1] + CORNER));
    for (int x = 0; x < width - 1; x++)
        row[x] = least(row[x], (int16_t)(beside[x + 1] + CORNER));
}

/**
 * Distances from the pixels that are 0; others come in as FAR. The steps of a shortest way may come
 * in any order: those along a row first, so that from row to row no pixel waits for its neighbour.
 */
static void measure(int16_t *plane, int width, int height)
{
    for (int y = 0; y < height; y++)
        measure_row(plane + (size_t)y * (size_t)width, width);
    for (int y = 1; y < height; y++)
        lower_from(plane + (size_t)(y - 1) * (size_t)width, plane + (size_t)y * (size_t)width,
                   width);
    for (int y = height - 2; y >= 0; y--)
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
static void mark_pixels(Part *part, const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box, box = part->box;
    memset(part->seen, 0, fl_rect_pixels(box));
    for (int y = 0; y < box.height; y++) {
        uint8_t *restrict over = part->over + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
        const uint8_t *coverage = above->coverage + i, *hides = above->hides + i;
        for (int x = 0; x < box.width; x++)
            over[x] = hides[x] & (coverage[x] >= SHOWN ? 255 : 0);
    }
    for (int y = 0; y < own.height; y++) {
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const size_t p = (size_t)(own.y + y - box.y) * (size_t)box.width + (size_t)(own.x - box.x);
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *over = part->over + p;
        uint8_t *restrict seen = part->seen + p;
        for (int x = span.first; x < span.last; x++)
            seen[x] = (coverage[x] >= SHOWN) & (over[x] == 0);
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

/** Distances out, and to blocks of 2x2 pixels in which the layer is seen: not to slivers. */
static void find_ways(Part *part)
{
    const int w = part->box.width, h = part->box.height;
    for (size_t p = 0; p < (size_t)w * (size_t)h; p++)
        part->to_open[p] = part->over[p] ? FAR : 0, part->to_seen[p] = FAR;
    g_autofree uint8_t *block = g_malloc((size_t)w);
    for (int y = 0; y + 1 < h; y++) {
        const size_t p = (size_t)y * (size_t)w, q = p + (size_t)w;
        mark_blocks(part->seen + p, part->seen + q, w, block);
        clear_blocks(block, w, part->to_seen + p);
        clear_blocks(block, w, part->to_seen + q);
    }
    measure(part->to_open, w, h);
    measure(part->to_seen, w, h);
}

/** Raises each of n values to the one that comes `reach` later, if that is more. */
static void raise_by(uint8_t *value, int n, int reach)
{
    for (int x = 0; x < n; x++)
        value[x] = MAX(value[x], value[x + reach]);
}

/**
 * How far what is above hides each pixel of a row, or where nothing is, at most within BESIDE_PX.
 * hides has 2 * BESIDE_PX more than the row.
 */
static void find_hides(const Part *part, int y, uint8_t *hides)
{
    const int width = part->box.width, padded = width + 2 * BESIDE_PX;
    const int last = MIN(y + BESIDE_PX, part->box.height - 1);
    memset(hides, 0, (size_t)padded);
    for (int ny = MAX(y - BESIDE_PX, 0); ny <= last; ny++) {
        const uint8_t *over = part->over + (size_t)ny * (size_t)width;
        uint8_t *restrict own = hides + BESIDE_PX;
        for (int x = 0; x < width; x++)
            own[x] = MAX(own[x], over[x]);
    }
    G_STATIC_ASSERT(BESIDE_PX == 3);
    raise_by(hides, padded - 1, 1); // of two, four and then seven
    raise_by(hides, padded - 3, 2);
    raise_by(hides, width, BESIDE_PX);
    const uint8_t *over = part->over + (size_t)y * (size_t)width;
    for (int x = 0; x < width; x++)
        hides[x] = over[x] ? over[x] : hides[x];
}

/** How much of the layer stays, 0..255: (2.5 out + 6 - to) / (out + 4), in pixels, where what is
 * above hides all. */
static int kept_at(const Part *part, size_t p, int hides)
{
    const int out = part->to_open[p], to = part->to_seen[p];
    const int share = 5 * out + 12 * SIDE - 2 * to, whole = 2 * (out + 4 * SIDE);
    if (share >= whole) // nearly everywhere: without the division
        return 255;
    const int keep = 255 * share / whole;
    return 255 - ((255 - MAX(keep, 0)) * hides + 127) / 255;
}

/** Row y of the layer; hides is of the pixels of its box. */
static void fade_row(const Part *part, FlLayer *layer, int y, const uint8_t *hides)
{
    const FlRect own = layer->area.box;
    const FlColumns span = fl_area_row(&layer->area, y);
    const size_t row = (size_t)y * (size_t)own.width;
    const size_t of_part =
        (size_t)(own.y + y - part->box.y) * (size_t)part->box.width + (size_t)(own.x - part->box.x);
    for (FlColumns run = fl_next_run(hides, span.first, span.last); run.first < run.last;
         run = fl_next_run(hides, run.last, span.last))
        for (int x = run.first; x < run.last; x++) {
            const size_t p = row + (size_t)x;
            const int keep = kept_at(part, of_part + (size_t)x, hides[x]);
            if (keep == 255)
                continue;
            layer->rgba[4 * p + 3] = (uint8_t)((layer->rgba[4 * p + 3] * keep + 127) / 255);
            layer->knockout[p] = (uint8_t)((layer->knockout[p] * keep + 127) / 255);
        }
}

static void fade(const Part *part, FlLayer *layer)
{
    const FlRect own = layer->area.box;
    g_autofree uint8_t *hides = g_malloc((size_t)(part->box.width + 2 * BESIDE_PX));
    for (int y = 0; y < own.height; y++) {
        find_hides(part, own.y + y - part->box.y, hides);
        fade_row(part, layer, y, hides + (own.x - part->box.x));
    }
}

static bool fade_layer(FlLayer *layer, const FlUnderlay *above, GError **error)
{
    g_auto(Part) part = {0};
    if (!is_below(layer, above))
        return true;
    if (!part_init(&part, layer, above->width, above->height, error))
        return false;
    mark_pixels(&part, layer, above);
    find_ways(&part);
    fade(&part, layer);
    return true;
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

bool fl_underlay_init(FlUnderlay *above, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *above = (FlUnderlay){.width = width, .height = height};
    return (above->coverage = fl_alloc(pixels, 1, "a matte", error)) &&
           (above->hides = fl_alloc(pixels, 1, "a matte", error));
}

void fl_underlay_clear(FlUnderlay *above)
{
    free(above->coverage);
    free(above->hides);
}

bool fl_underlay_fade_next(FlUnderlay *above, FlLayer *layer, GError **error)
{
    const bool knocks = layer->stacking == FL_STACKING_KNOCKOUT && layer->mix == FL_BLEND_MODE_OVER;
    if (layer->knockout && knocks && fl_rect_pixels(layer->area.box) > 0 &&
        !fade_layer(layer, above, error))
        return false;
    if (knocks && !layer->sheer)
        add_above(layer, above);
    return true;
}

bool fl_underlay_fade(FlLayer *layers, int n, int width, int height, GError **error)
{
    g_auto(FlUnderlay) above = {0};
    bool done = fl_underlay_init(&above, width, height, error);
    for (int k = n - 1; k >= 0 && done; k--)
        done = fl_underlay_fade_next(&above, &layers[k], error);
    return done;
}
