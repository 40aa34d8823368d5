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

/** One row of a distance transform: from the row before, and along itself. */
static void lower_row(uint16_t *row, const uint16_t *before, int width, int on)
{
    for (int k = 0; k < width; k++) {
        const int x = on > 0 ? k : width - 1 - k;
        int least = row[x];
        if (before) {
            least = MIN(least, before[x] + SIDE);
            least = MIN(least, x > 0 ? before[x - 1] + CORNER : FAR);
            least = MIN(least, x < width - 1 ? before[x + 1] + CORNER : FAR);
        }
        if (k > 0)
            least = MIN(least, row[x - on] + SIDE);
        row[x] = (uint16_t)least;
    }
}

/** Distances from the pixels that are 0; others come in as FAR. */
static void measure(uint16_t *plane, int width, int height)
{
    for (int y = 0; y < height; y++) {
        uint16_t *row = plane + (size_t)y * (size_t)width;
        lower_row(row, y > 0 ? row - width : NULL, width, 1);
    }
    for (int y = height - 1; y >= 0; y--) {
        uint16_t *row = plane + (size_t)y * (size_t)width;
        lower_row(row, y < height - 1 ? row + width : NULL, width, -1);
    }
}

/** The shapes above the layer at hand. */
typedef struct Above {
    uint8_t *coverage; // of the frame, the greatest
    uint8_t *hides;    // 0..255, the greatest of those that are there
} Above;

/** Fills over and seen. Returns: whether anything lies over the layer's shape. */
static bool mark_pixels(Part *part, const FlLayer *layer, const Above *above, int width)
{
    const FlRect own = layer->area.box, box = part->box;
    bool any = false;
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const int lx = box.x + x - own.x, ly = box.y + y - own.y;
            const bool within = lx >= 0 && ly >= 0 && lx < own.width && ly < own.height;
            const uint8_t coverage =
                within ? layer->coverage[(size_t)ly * (size_t)own.width + (size_t)lx] : 0;
            const size_t p = (size_t)y * (size_t)box.width + (size_t)x;
            const size_t i = (size_t)(box.y + y) * (size_t)width + (size_t)(box.x + x);
            const uint8_t over = above->coverage[i];
            part->over[p] = over >= SHOWN ? above->hides[i] : 0;
            part->seen[p] = coverage >= SHOWN && !part->over[p];
            any |= coverage && over;
        }
    return any;
}

/** Distances out, and to blocks of 2x2 pixels in which the layer is seen: not to slivers. */
static void find_ways(Part *part)
{
    const int w = part->box.width, h = part->box.height;
    const uint8_t *seen = part->seen;
    for (size_t p = 0; p < (size_t)w * (size_t)h; p++)
        part->to_open[p] = part->over[p] ? FAR : 0, part->to_seen[p] = FAR;
    for (int y = 0; y + 1 < h; y++)
        for (int x = 0; x + 1 < w; x++) {
            const size_t p = (size_t)y * (size_t)w + (size_t)x, q = p + (size_t)w;
            if (seen[p] & seen[p + 1] & seen[q] & seen[q + 1])
                part->to_seen[p] = part->to_seen[p + 1] = part->to_seen[q] = part->to_seen[q + 1] =
                    0;
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
    const int keep = 255 * (5 * out + 12 * SIDE - 2 * to) / (2 * (out + 4 * SIDE));
    if (keep >= 255)
        return 255;
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

static bool fade_layer(FlLayer *layer, const Above *above, int width, int height, GError **error)
{
    g_auto(Part) part = {0};
    if (!part_init(&part, layer, width, height, error))
        return false;
    if (mark_pixels(&part, layer, above, width)) {
        find_ways(&part);
        fade(&part, layer);
    }
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

static void add_above(const FlLayer *layer, int width, const Above *above)
{
    const FlRect box = layer->area.box;
    const int hides = hiding(layer->alpha);
    for (int y = 0; y < box.height && hides > 0; y++) {
        const FlColumns span = fl_area_row(&layer->area, y);
        const uint8_t *coverage = layer->coverage + (size_t)y * (size_t)box.width;
        const size_t i = (size_t)(box.y + y) * (size_t)width + (size_t)box.x;
        for (int x = span.first; x < span.last; x++) {
            above->coverage[i + (size_t)x] = MAX(above->coverage[i + (size_t)x], coverage[x]);
            if (coverage[x] >= SHOWN)
                above->hides[i + (size_t)x] = (uint8_t)MAX(above->hides[i + (size_t)x], hides);
        }
    }
}

bool fl_underlay_fade(FlLayer *layers, int n, int width, int height, GError **error)
{
    const size_t pixels = (size_t)width * (size_t)height;
    g_autofree uint8_t *coverage = fl_alloc(pixels, 1, "a matte", error);
    g_autofree uint8_t *hides = coverage ? fl_alloc(pixels, 1, "a matte", error) : NULL;
    if (!hides)
        return false;
    const Above above = {coverage, hides};
    for (int k = n - 1; k >= 0; k--) {
        FlLayer *layer = &layers[k];
        const bool knocks =
            layer->stacking == FL_STACKING_KNOCKOUT && layer->mix == FL_BLEND_MODE_OVER;
        if (layer->knockout && knocks && k < n - 1 && fl_rect_pixels(layer->area.box) > 0 &&
            !fade_layer(layer, &above, width, height, error))
            return false;
        if (knocks && !layer->sheer)
            add_above(layer, width, &above);
    }
    return true;
}
