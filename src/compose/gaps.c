#include "compose/gaps.h"

#include "base/alloc.h"
#include "base/noise.h"
#include "base/rng.h"
#include <math.h>

enum { KEY_X = 401, KEY_Y };

#define MOST_PX 1.7f // px of the page that an edge is off, nearly at most
#define CELL_PX 42   // of the page, from one place that is off to the next
#define ROOM_PX 2    // px of the page by which a layer grows

/* The places from which some pixels of a row come. */
typedef struct Sources {
    float x[FL_NOISE_ROW], y[FL_NOISE_ROW];
} Sources;

static void find_sources(const FlGaps *gaps, int x, int y, int n, Sources *from)
{
    const float px = 1 / (gaps->scale * CELL_PX), most = gaps->strength * MOST_PX * gaps->scale;
    float across[FL_NOISE_ROW], down[FL_NOISE_ROW], off[2][FL_NOISE_ROW];
    fl_anchor_rest_row(&gaps->anchor, x, y, 1, n, px, across, down);
    fl_noise_octaves_row(fl_key(gaps->key, KEY_X), across, down, n, 2, .5f, off[0]);
    fl_noise_octaves_row(fl_key(gaps->key, KEY_Y), across, down, n, 2, .5f, off[1]);
    for (int i = 0; i < n; i++) {
        from->x[i] = (float)(x + i) + most * CLAMP(1.6f * off[0][i], -1, 1);
        from->y[i] = (float)y + most * CLAMP(1.6f * off[1][i], -1, 1);
    }
}

static int at(const uint8_t *plane, FlRect box, int x, int y)
{
    const bool inside = x >= 0 && y >= 0 && x < box.width && y < box.height;
    return inside ? plane[(size_t)y * (size_t)box.width + (size_t)x] : 0;
}

/* A plane between its pixels; x, y of the frame. */
static uint8_t between(const uint8_t *plane, FlRect box, float x, float y)
{
    const int left = (int)floorf(x), top = (int)floorf(y);
    const float tx = x - (float)left, ty = y - (float)top;
    const int u = left - box.x, v = top - box.y;
    const float upper =
        (float)at(plane, box, u, v) * (1 - tx) + (float)at(plane, box, u + 1, v) * tx;
    const float lower =
        (float)at(plane, box, u, v + 1) * (1 - tx) + (float)at(plane, box, u + 1, v + 1) * tx;
    return (uint8_t)(upper + (lower - upper) * ty + .5f);
}

/* The nearest pixel of paint to a place, of the four around it. */
static uint32_t paint_at(const FlLayer *layer, float x, float y)
{
    const FlRect box = layer->area.box;
    const int left = (int)floorf(x) - box.x, top = (int)floorf(y) - box.y;
    const float tx = x - floorf(x), ty = y - floorf(y);
    float best = -1;
    uint32_t paint = 0;
    for (int k = 0; k < 4; k++) {
        const int u = left + k % 2, v = top + k / 2;
        const float near = (k % 2 ? tx : 1 - tx) * (k / 2 ? ty : 1 - ty);
        if (near <= best || at(layer->coverage, box, u, v) == 0)
            continue;
        best = near;
        memcpy(&paint, layer->rgba + 4 * ((size_t)v * (size_t)box.width + (size_t)u), 4);
    }
    return paint;
}

/* A layer whose edges are off. */
typedef struct Moved {
    FlRect box;
    uint8_t *coverage, *knockout, *rgba;
} Moved;

/* Beyond its own edge paint lies over what is there, which is darker for it. */
static void move_row(const FlLayer *layer, const FlGaps *gaps, const Moved *moved, int y)
{
    const FlRect box = moved->box, own = layer->area.box;
    Sources from;
    for (int x = 0; x < box.width; x += FL_NOISE_ROW) {
        const int n = MIN(FL_NOISE_ROW, box.width - x);
        find_sources(gaps, box.x + x, box.y + y, n, &from);
        for (int i = 0; i < n; i++) {
            const size_t p = (size_t)y * (size_t)box.width + (size_t)(x + i);
            const int here = at(layer->coverage, own, box.x + x + i - own.x, box.y + y - own.y);
            const int covered = between(layer->coverage, own, from.x[i], from.y[i]);
            moved->coverage[p] = (uint8_t)covered;
            if (covered == 0)
                continue;
            const uint32_t paint = paint_at(layer, from.x[i], from.y[i]);
            const int knocks = between(layer->knockout, own, from.x[i], from.y[i]);
            memcpy(moved->rgba + 4 * p, &paint, 4);
            moved->knockout[p] = (uint8_t)(knocks * MIN(here, covered) / covered);
        }
    }
}

bool fl_layer_open_gaps(FlLayer *layer, const FlGaps *gaps, FlRect page, GError **error)
{
    const int room = (int)ceilf(ROOM_PX * gaps->scale);
    Moved moved = {.box = fl_rect_grown(layer->area.box, room, page)};
    const size_t n = fl_rect_pixels(moved.box);
    if (gaps->strength <= 0 || !layer->knockout)
        return true;
    moved.coverage = fl_alloc(n, 1, "a layer", error);
    moved.knockout = moved.coverage ? fl_alloc(n, 1, "a layer", error) : NULL;
    moved.rgba = moved.knockout ? fl_alloc(n, 4, "a layer", error) : NULL;
    if (!moved.rgba) {
        free(moved.coverage);
        free(moved.knockout);
        return false;
    }
#pragma omp parallel for schedule(static)
    for (int y = 0; y < moved.box.height; y++)
        move_row(layer, gaps, &moved, y);
    fl_area_clear(&layer->area);
    free(layer->rgba);
    free(layer->knockout);
    if (layer->owns_coverage)
        free((uint8_t *)layer->coverage);
    layer->area = (FlArea){moved.box, NULL};
    layer->coverage = moved.coverage, layer->owns_coverage = true;
    layer->knockout = moved.knockout, layer->rgba = moved.rgba;
    return true;
}
