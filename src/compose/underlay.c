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
    uint8_t *over;     // how far what covers the pixel from above hides, 0..255; 0: nothing does
    uint8_t *seen;     // 1: the layer is seen
    uint16_t *to_open; // distances, fifths of a px: to what nothing above covers
    uint16_t *to_seen; // to where the layer is seen
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
    return (part->over = fl_alloc(n, 1, "a matte", error)) &&
           (part->seen = fl_alloc(n, 1, "a matte", error)) &&
           (part->to_open = fl_alloc(n, sizeof *part->to_open, "a matte", error)) &&
           (part->to_seen = fl_alloc(n, sizeof *part->to_seen, "a matte", error));
}

/** A row of a distance transform, as far as the row before it tells: no pixel waits for another. */
static void lower_from_before(uint16_t *restrict row, const uint16_t *restrict before, int width)
{
    for (int x = 0; x < width; x++)
        row[x] = MIN(row[x], (uint16_t)(before[x] + SIDE));
    for (int x = 1; x < width; x++)
        row[x] = MIN(row[x], (uint16_t)(before[x - 1] + CORNER));
    for (int x = 0; x < width - 1; x++)
        row[x] = MIN(row[x], (uint16_t)(before[x + 1] + CORNER));
}

/** The same along the row; on: 1 to the right, -1 to the left. */
static void lower_along(uint16_t *row, int width, int on)
{
    int least = FAR;
    for (int k = 0, x = on > 0 ? 0 : width - 1; k < width; k++, x += on) {
        least = MIN(row[x], least + SIDE);
        row[x] = (uint16_t)least;
    }
}

/** Distances from the pixels that are 0; others come in as FAR. */
static void measure(uint16_t *plane, int width, int height)
{
    for (int y = 0; y < height; y++) {
        uint16_t *row = plane + (size_t)y * (size_t)width;
        if (y > 0)
            lower_from_before(row, row - width, width);
        lower_along(row, width, 1);
    }
    for (int y = height - 1; y >= 0; y--) {
        uint16_t *row = plane + (size_t)y * (size_t)width;
        if (y < height - 1)
            lower_from_before(row, row + width, width);
        lower_along(row, width, -1);
    }
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
            any |= coverage[x] && over[x];
    }
    return any;
}

/** Fills over and seen. */
static void mark_pixels(Part *part, const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box, box = part->box;
    memset(part->seen, 0, fl_rect_pixels(box));
    for (int y = 0; y < box.height; y++) {
        uint8_t *over = part->over + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
        for (int x = 0; x < box.width; x++)
            over[x] = above->coverage[i + (size_t)x] >= SHOWN ? above->hides[i + (size_t)x] : 0;
    }
    for (int y = 0; y < own.height; y++) {
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const size_t p = (size_t)(own.y + y - box.y) * (size_t)box.width + (size_t)(own.x - box.x);
        const FlColumns span = fl_area_row(&layer->area, y);
        for (int x = span.first; x < span.last; x++)
            part->seen[p + (size_t)x] = coverage[x] >= SHOWN && !part->over[p + (size_t)x];
    }
}

/** Marks blocks of 2x2 pixels, of two rows, in which the layer is seen: by their left columns. */
static void mark_blocks(const uint8_t *seen, const uint8_t *below, int width, uint8_t *block)
{
    for (int x = 0; x + 1 < width; x++)
        block[x] = seen[x] & seen[x + 1] & below[x] & below[x + 1];
}

/** Clears the distances of the pixels of a row that blocks hold. */
static void clear_blocks(const uint8_t *block, int width, uint16_t *row)
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

/** How far what is above hides, at most, within BESIDE_PX. */
static int hidden_beside(const Part *part, int x, int y)
{
    const FlRect box = part->box;
    int most = 0;
    for (int ny = MAX(y - BESIDE_PX, 0); ny <= MIN(y + BESIDE_PX, box.height - 1); ny++)
        for (int nx = MAX(x - BESIDE_PX, 0); nx <= MIN(x + BESIDE_PX, box.width - 1); nx++)
            most = MAX(most, part->over[(size_t)ny * (size_t)box.width + (size_t)nx]);
    return most;
}

/** How much of the layer stays, 0..255: (2.5 out + 6 - to) / (out + 4), in pixels, where what is
 * above hides all. */
static int kept_at(const Part *part, int x, int y)
{
    const size_t p = (size_t)y * (size_t)part->box.width + (size_t)x;
    const int out = part->to_open[p], to = part->to_seen[p];
    const int share = 5 * out + 12 * SIDE - 2 * to, whole = 2 * (out + 4 * SIDE);
    if (share >= whole) // nearly everywhere: without the division
        return 255;
    const int keep = 255 * share / whole;
    const int hides = part->over[p] ? part->over[p] : hidden_beside(part, x, y);
    return 255 - ((255 - MAX(keep, 0)) * hides + 127) / 255;
}

static void fade(const Part *part, FlLayer *layer)
{
    const FlRect own = layer->area.box;
    for (int y = 0; y < own.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        for (int x = span.first; x < span.last; x++) {
            const size_t p = (size_t)y * (size_t)own.width + (size_t)x;
            const int keep = kept_at(part, own.x + x - part->box.x, own.y + y - part->box.y);
            if (keep == 255)
                continue;
            layer->rgba[4 * p + 3] = (uint8_t)((layer->rgba[4 * p + 3] * keep + 127) / 255);
            layer->knockout[p] = (uint8_t)((layer->knockout[p] * keep + 127) / 255);
        }
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
    const int hides = hiding(layer->alpha);
    for (int y = 0; y < box.height && hides > 0; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)above->width + (size_t)box.x;
        for (int x = span.first; x < span.last; x++) {
            above->coverage[i + (size_t)x] = MAX(above->coverage[i + (size_t)x], coverage[x]);
            if (coverage[x] >= SHOWN)
                above->hides[i + (size_t)x] = (uint8_t)MAX(above->hides[i + (size_t)x], hides);
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
