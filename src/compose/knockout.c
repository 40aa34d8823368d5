#include "compose/knockout.h"

#include "base/alloc.h"
#include "base/windows.h"
#include "compose/ink.h"

#define PART(x) (FL_AMOUNT_ONE * (x) / 10)

/** Paint is transparent up to an amount, and hides all from another one on. */
typedef struct Ramp {
    int none, all;
} Ramp;

/** The ramps of a medium, at the contour and amid a shape. */
typedef struct Ramps {
    Ramp rim, amid;
} Ramps;

/*
 * Rims of a fifth hide nothing: where the shape lies over other paint they would be an even light
 * line around it, thin paint on white paper. Those of white hide all, since it has no such line,
 * and its shadow on the paint below would be a dark one. Amid a shape thin washes lie on paper,
 * around which the paint below went: else they would be mottled with it. A hole in them shows what
 * lies below. Thin places of an opaque medium let it through everywhere, the more the darker they
 * are: paper shows least in light paint. Paint that is cut out with its paper has that below it.
 */
static Ramps ramps_of(FlMedium medium, int darkness, float white)
{
    const int none = PART(6) * darkness / 255;
    const Ramp rim = {(int)(PART(2) * (1 - white)), (int)(PART(6) - PART(4) * white)};
    const Ramp opaque = {none, none + PART(3)};
    if (medium == FL_MEDIUM_OPAQUE)
        return (Ramps){opaque, opaque};
    return (Ramps){rim, medium == FL_MEDIUM_BODY ? (Ramp){-1, 0} : (Ramp){0, PART(3)}};
}

/** The share of what lies below that an amount hides, 0..255. */
static int hides(const Ramp *ramp, int amount)
{
    return 255 * (CLAMP(amount, ramp->none, ramp->all) - ramp->none) / (ramp->all - ramp->none);
}

#define TILE_PX 128              // a tile and what is around it fit into a processor's own cache
#define ONE 1024                 // of shares
#define RIM_SHARE (ONE * 7 / 10) // up to here a pixel is at the contour, which itself has one half
#define INNER_SHARE (ONE * 19 / 20) // from here on amid the shape

/** A pixel's depth in the shape, from its contour, 0, to its middle, ONE. */
static int amid(uint32_t share)
{
    const int t =
        (CLAMP((int)share, RIM_SHARE, INNER_SHARE) - RIM_SHARE) * ONE / (INNER_SHARE - RIM_SHARE);
    return t * t / ONE * (3 * ONE - 2 * t) / ONE;
}

/** The pixels of a frame's side that are within `radius` of one of them. */
static uint32_t side_around(int at, int side, int radius)
{
    return (uint32_t)(MIN(at + radius, side - 1) - MAX(at - radius, 0) + 1);
}

/** share and all: of the window that is the shape's, of ONE. */
static int hidden(const Ramps *ramps, int amount, uint64_t share, uint64_t all)
{
    const int rim = hides(&ramps->rim, amount), inner = hides(&ramps->amid, amount);
    if (share < (RIM_SHARE + 1) * all) // without a division, as nearly everywhere
        return rim;
    if (share >= INNER_SHARE * all)
        return inner;
    return rim + (inner - rim) * amid((uint32_t)(share / all)) / ONE;
}

/** Three rows of coverage. */
typedef struct Rows {
    const uint8_t *own, *above, *below;
} Rows;

static int16_t inside_at(const Rows *rows, int x, int left, int right)
{
    const uint8_t beside = MIN(rows->own[left], rows->own[right]);
    const uint8_t least = MIN(MIN(rows->own[x], beside), MIN(rows->above[x], rows->below[x]));
    return least > 0 ? 255 : rows->own[x];
}

/**
 * The share of each pixel of a box that is inside a shape, 0..255: the coverage of pixels at its
 * contour, next to one without coverage; all of those within, however faint their fill.
 */
static void find_inside(const uint8_t *coverage, int width, int height, FlRect box, int16_t *inside)
{
    const int end = box.x + box.width;
    for (int y = box.y; y < box.y + box.height; y++) {
        const uint8_t *own = coverage + (size_t)y * (size_t)width;
        const Rows rows = {own, y > 0 ? own - width : own, y + 1 < height ? own + width : own};
        int16_t *restrict row = inside + (size_t)(y - box.y) * (size_t)box.width;
        for (int x = MAX(box.x, 1); x < MIN(end, width - 1); x++)
            row[x - box.x] = inside_at(&rows, x, x - 1, x + 1);
        if (box.x == 0)
            row[0] = inside_at(&rows, 0, 0, MIN(1, width - 1));
        if (end == width)
            row[width - 1 - box.x] = inside_at(&rows, width - 1, MAX(width - 2, 0), width - 1);
    }
}

/** A part of the box that contains some of the shape, and a margin around that part. */
typedef struct Tile {
    FlRect own, around; // around: with all that its windows hold; of the box, as own is
    int16_t *inside;    // of around
    uint32_t *sums;
} Tile;

static void tile_clear(Tile *tile)
{
    free(tile->inside);
    free(tile->sums);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Tile, tile_clear)

/** A tile of TILE_PX and more, with room for all of them. */
static bool tile_init(Tile *tile, int radius_px, GError **error)
{
    const size_t side = (size_t)(TILE_PX + 2 * radius_px), n = side * side;
    *tile = (Tile){0};
    return (tile->inside = fl_alloc_unset(n, sizeof *tile->inside, "a matte", error)) &&
           (tile->sums = fl_alloc_unset(n, sizeof *tile->sums, "a matte", error));
}

/** Sums what is inside the shape. */
static void sum_tile(Tile *tile, FlRect own, FlRect box, const uint8_t *coverage, int radius_px)
{
    tile->own = own;
    tile->around = fl_rect_grown(own, radius_px, (FlRect){0, 0, box.width, box.height});
    find_inside(coverage, box.width, box.height, tile->around, tile->inside);
    fl_window_sums(tile->inside, tile->around, radius_px, tile->sums);
}

/** The place of a box in a frame, and what the paint hides. */
typedef struct Windows {
    FlRect box;
    int width, height, radius_px; // of the frame
    Ramps ramps;
} Windows;

static void hide_tile(const Tile *tile, const Windows *w, const int16_t *amounts, uint8_t *knockout)
{
    const FlRect own = tile->own, around = tile->around;
    for (int y = own.y; y < own.y + own.height; y++) {
        const uint32_t *sums =
            tile->sums + (size_t)(y - around.y) * (size_t)around.width - around.x;
        const uint32_t down = side_around(w->box.y + y, w->height, w->radius_px);
        for (int x = own.x; x < own.x + own.width; x++) {
            const size_t p = (size_t)y * (size_t)w->box.width + (size_t)x;
            if (amounts[p] >= w->ramps.rim.all) { // wherever it is
                knockout[p] = 255;
                continue;
            }
            const uint64_t all = 255ull * down * side_around(w->box.x + x, w->width, w->radius_px);
            knockout[p] = (uint8_t)hidden(&w->ramps, amounts[p], (uint64_t)sums[x] * ONE, all);
        }
    }
}

bool fl_knockout(const int16_t *amounts, const uint8_t *coverage, const uint8_t *shown, FlRect box,
                 int width, int height, int radius_px, FlMedium medium, int darkness, float white,
                 uint8_t *knockout, GError **error)
{
    const Windows windows = {box, width, height, radius_px, ramps_of(medium, darkness, white)};
    g_auto(Tile) tile = {0};
    if (!tile_init(&tile, radius_px, error))
        return false;
    for (int y = 0; y < box.height; y += TILE_PX)
        for (int x = 0; x < box.width; x += TILE_PX) {
            const FlRect whole = {x, y, MIN(TILE_PX, box.width - x), MIN(TILE_PX, box.height - y)};
            const FlRect own = fl_rect_within(shown, box.width, whole);
            if (own.width == 0) // many shapes are far smaller than their box
                continue;
            sum_tile(&tile, own, box, coverage, radius_px);
            hide_tile(&tile, &windows, amounts, knockout);
        }
    return true;
}
