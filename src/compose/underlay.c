#include "compose/underlay.h"

#include "base/alloc.h"
#include "base/schedule.h"
#include "cover/cover_map.h"
#include <math.h>
#include <string.h>

#define MARGIN_PX 4
#define SIDE 5 // a step of the distances, and one to a corner
#define CORNER 7
#define FAR 30000
#define BESIDE_PX 3 // a sliver farther from what lies above is a shape of its own

void fl_fade_clear(FlFade *fade)
{
    free(fade->open);
    free(fade->keep);
    *fade = (FlFade){0};
}

static bool fade_init(FlFade *fade, const FlLayer *layer, const FlUnderlay *above, GError **error)
{
    const FlRect page = {0, 0, above->width, above->height};
    fade->box = fl_rect_grown(layer->area.box, MARGIN_PX, page);
    const size_t n = fl_rect_pixels(fade->box);
    return (fade->open = fl_alloc_unset(n, 1, "a matte", error)) &&
           (fade->keep = fl_alloc_unset(n, 1, "a matte", error));
}

/** Distances of the pixels of a fade's box, fifths of a px. */
typedef struct Ways {
    int16_t *to_open; // to a pixel that the shapes above leave open
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

static int16_t least(int16_t a, int16_t b)
{
    return MIN(a, b);
}

/** Lowers a row's distances to what those beside it in the row tell. */
static void lower_row(int16_t *row, int width)
{
    for (int x = 1; x < width; x++)
        row[x] = least(row[x], (int16_t)(row[x - 1] + SIDE));
    for (int x = width - 2; x >= 0; x--)
        row[x] = least(row[x], (int16_t)(row[x + 1] + SIDE));
}

/** The same for the row before or after. */
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
 * The least, over all pixels, of what a pixel has and the way to it; of some rows. The steps of a
 * shortest way may come in any order: those along a row first, so that from row to row no pixel
 * waits for its neighbour.
 */
static void measure(int16_t *plane, int width, int height, Lines wanted)
{
    for (int y = 0; y < height; y++)
        lower_row(plane + (size_t)y * (size_t)width, width);
    for (int y = 1; y < wanted.last; y++)
        lower_from(plane + (size_t)(y - 1) * (size_t)width, plane + (size_t)y * (size_t)width,
                   width);
    for (int y = height - 2; y >= wanted.first; y--)
        lower_from(plane + (size_t)(y + 1) * (size_t)width, plane + (size_t)y * (size_t)width,
                   width);
}

/** The distance that a pixel of each share 0..255 adds: 0 if it is open, or seen, in full, and more
 * as the share falls, so that a lower layer fades while the shape above it grows opaque. */
static void find_costs(int16_t cost[256])
{
    cost[0] = FAR;
    for (int share = 1; share < 256; share++)
        cost[share] = (int16_t)(5 * SIDE * (255 - share) / sqrt(255.0 * share));
}

/** Returns: true if the layer lies below any shape. */
static bool is_below(const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box;
    uint8_t any = 0;
    for (int y = 0; y < own.height && !any; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const uint8_t *open = above->free + (size_t)(own.y + y) * (size_t)above->width + own.x;
        for (int x = span.first; x < span.last; x++)
            any |= coverage[x] & (uint8_t)~open[x];
    }
    return any;
}

/** Fills `open` around the layer, and `keep` with the visible share of the layer. */
static void mark_pixels(FlFade *fade, const FlLayer *layer, const FlUnderlay *above)
{
    const FlRect own = layer->area.box, box = fade->box;
    fl_rect_copy(above->free, (FlRect){0, 0, above->width, above->height}, fade->open, box, 1);
    memset(fade->keep, 0, fl_rect_pixels(box));
    for (int y = 0; y < own.height; y++) {
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)own.width;
        const size_t p = (size_t)(own.y + y - box.y) * (size_t)box.width + (size_t)(own.x - box.x);
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *open = fade->open + p;
        uint8_t *restrict seen = fade->keep + p;
        for (int x = span.first; x < span.last; x++)
            seen[x] = (uint8_t)MAX(coverage[x] + open[x] - 255,
                                   0); // a pixel in which both end shows neither
    }
}

/** The least of each block of 2x2 pixels of two rows, by their left columns. */
static void find_blocks(const uint8_t *seen, const uint8_t *below, int width, uint8_t *block)
{
    for (int x = 0; x + 1 < width; x++)
        block[x] = MIN(MIN(seen[x], seen[x + 1]), MIN(below[x], below[x + 1]));
}

/** Raises the pixels of a row to the blocks that hold them. */
static void raise_to_blocks(const uint8_t *block, int width, uint8_t *restrict row)
{
    for (int x = 0; x + 1 < width; x++)
        row[x] = MAX(row[x], block[x]);
    for (int x = 1; x < width; x++)
        row[x] = MAX(row[x], block[x - 1]);
}

/** Takes out of a plane of shares what is no part of a block of 2x2 pixels: slivers. */
static bool take_slivers(uint8_t *seen, int width, int height, GError **error)
{
    const size_t w = (size_t)width;
    g_autofree uint8_t *block = fl_alloc(2 * w, 1, "a row of a matte", error);
    for (int y = 0; block && y < height; y++) { // the blocks of this row and of the one before
        uint8_t *row = seen + (size_t)y * w, *blocks = block + (size_t)(y % 2) * w;
        if (y + 1 < height)
            find_blocks(row, row + w, width, blocks);
        else
            memset(blocks, 0, w);
        memset(row, 0, w);
        raise_to_blocks(block, width, row);
        raise_to_blocks(block + w, width, row);
    }
    return block;
}

/** Distances to where a plane of shares of the fade's box is full. */
static void find_ways(const FlFade *fade, const uint8_t *share, Lines wanted, int16_t *ways)
{
    int16_t cost[256];
    find_costs(cost);
    for (size_t p = 0; p < fl_rect_pixels(fade->box); p++)
        ways[p] = cost[share[p]];
    measure(ways, fade->box.width, fade->box.height, wanted);
}

/** The share of a layer that stays, 0..255, below a shape that is bare of paint: (2.5 out + 6 - to)
 * / (out + 4), in px of the frame. */
static uint8_t kept(int out, int to)
{
    const int share = 5 * out + 12 * SIDE - 2 * to, whole = 2 * (out + 4 * SIDE);
    return share >= whole ? 255 : (uint8_t)(255 * MAX(share, 0) / whole);
}

/** Lowers each of n values to the one that comes `reach` later, if that is less. */
static void lower_by(uint8_t *value, int n, int reach)
{
    for (int x = 0; x < n; x++)
        value[x] = MIN(value[x], value[x + reach]);
}

/** Lowers what is open to the least within BESIDE_PX: what is as near to a shape above as that
 * belongs to its edge. */
static bool open_less(FlFade *fade, GError **error)
{
    enum { beside = BESIDE_PX, window = 2 * beside + 1 };
    const int width = fade->box.width, height = fade->box.height, padded = width + 2 * beside;
    g_autofree uint8_t *rows = fl_alloc(fl_rect_pixels(fade->box), 1, "a matte", error);
    g_autofree uint8_t *least_of = rows ? fl_alloc((size_t)padded, 1, "a row", error) : NULL;
    if (!least_of)
        return false;
    memcpy(rows, fade->open, fl_rect_pixels(fade->box));
    for (int y = 0; y < height; y++) {
        uint8_t *own = least_of + beside;
        memset(least_of, 255, (size_t)padded);
        for (int ny = MAX(y - beside, 0); ny <= MIN(y + beside, height - 1); ny++)
            for (int x = 0; x < width; x++)
                own[x] = MIN(own[x], rows[(size_t)ny * (size_t)width + (size_t)x]);
        int size = 1; // of the windows of which least_of has the least
        for (int left = padded; 2 * size <= window; size *= 2)
            lower_by(least_of, left -= size, size);
        lower_by(least_of, width, window - size);
        memcpy(fade->open + (size_t)y * (size_t)width, least_of, (size_t)width);
    }
    return true;
}

bool fl_underlay_init(FlUnderlay *above, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    *above = (FlUnderlay){.width = width, .height = height};
    if (!(above->free = fl_alloc_unset(pixels, 1, "a matte", error)))
        return false;
    memset(above->free, 255, pixels);
    return true;
}

void fl_underlay_clear(FlUnderlay *above)
{
    free(above->free);
}

bool fl_underlay_next(FlUnderlay *above, FlLayer *layer, bool painted, GError **error)
{
    const FlRect page = {0, 0, above->width, above->height};
    const bool knocks = fl_layer_knocks_out(layer);
    if (painted && knocks && is_below(layer, above)) {
        if (!fade_init(&layer->fade, layer, above, error))
            return false;
        mark_pixels(&layer->fade, layer, above);
    }
    if (knocks && !layer->sheer)
        fl_cover_hide(&layer->area, layer->coverage, layer->alpha, page, above->free);
    return true;
}

/** The rows of a fade in which there is some of the layer. */
static Lines lines_of(const FlLayer *layer)
{
    const int above = layer->area.box.y - layer->fade.box.y;
    Lines lines = {layer->fade.box.height, 0};
    for (int y = 0; y < layer->area.box.height; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        if (span.first < span.last)
            lines = (Lines){MIN(lines.first, above + y), above + y + 1};
    }
    return lines;
}

bool fl_fade_find(FlLayer *layer, GError **error)
{
    FlFade *fade = &layer->fade;
    const size_t n = fl_rect_pixels(fade->box);
    g_auto(Ways) ways = {0};
    if (!fade->open)
        return true;
    if (!ways_init(&ways, n, error) ||
        !take_slivers(fade->keep, fade->box.width, fade->box.height, error))
        return false;
    const Lines wanted = lines_of(layer);
#pragma omp parallel sections if (fl_schedule_worth_threads(n))
    {
        find_ways(fade, fade->open, wanted, ways.to_open);
#pragma omp section
        find_ways(fade, fade->keep, wanted, ways.to_seen);
    }
    for (size_t p = 0; p < n; p++)
        fade->keep[p] = kept(ways.to_open[p], ways.to_seen[p]);
    return open_less(fade, error);
}
