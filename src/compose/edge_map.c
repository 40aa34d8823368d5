#include "compose/edge_map.h"

#include "base/alloc.h"
#include "base/parallel_error.h"
#include "compose/closing.h"
#include "compose/interior.h"
#include <string.h>

#define SHOWN 128       // coverage from which on a shape can be uppermost
#define TRAP_PX 4       // neighbours overlap by so much at most where a program traps them
#define MOST_DRAWS 4095 // whose overlaps are known
#define TILE_PX 128     // a tile and what is around it fit into a processor's own cache

/** How much a draw hides of what it lies over, 0 … 255. Shading does not: the edges below it are
 * seen. What fades must not let go of its neighbours in one frame. */
static int hiding(const FlComposeInput *input, const FlDraw *draw)
{
    if (draw->blend_mode != FL_BLEND_MODE_OVER)
        return 0;
    const bool painted = input->painted_of[draw->region] >= 0;
    return painted ? draw->alpha : MAX((int)draw->alpha * 4 - 3 * 255, 0);
}

/** Where pixel 0 of row y of a box is in the frame. */
static size_t in_frame(const FlEdgeMap *edges, FlRect box, int y)
{
    return (size_t)(box.y + y) * (size_t)fl_drawing_width(edges->input->drawing) + (size_t)box.x;
}

/** The coverage of a draw from column 0 of row y of its box on. */
static const uint8_t *coverage_row(const FlDraw *draw, int y)
{
    return draw->coverage + (size_t)y * (size_t)draw->area.box.width;
}

/** Whether a shape, whose rows these are, holds the corners of a square of TRAP_PX. */
static bool holds_square(const uint8_t *upper, const uint8_t *lower)
{
    return upper[0] >= SHOWN && upper[TRAP_PX] >= SHOWN && lower[0] >= SHOWN &&
           lower[TRAP_PX] >= SHOWN;
}

/** The draw that is uppermost at all corners of the one from pixel i on; 0: none. */
static uint16_t top_of_square(const uint16_t *top, size_t i, size_t width)
{
    const size_t down = i + TRAP_PX * width;
    const bool same =
        top[i + TRAP_PX] == top[i] && top[down] == top[i] && top[down + TRAP_PX] == top[i];
    return same ? top[i] : 0;
}

/** Notes which draws one, put over those below it, overlaps in some square of TRAP_PX. */
static void note_overlaps(FlEdgeMap *edges, int draw)
{
    const FlDraw *r = &edges->draws->draw[draw];
    const size_t width = (size_t)fl_drawing_width(edges->input->drawing), n = (size_t)edges->n;
    for (int y = 0; y < r->area.box.height - TRAP_PX; y++) {
        const size_t row = in_frame(edges, r->area.box, y), own = (size_t)draw + 1;
        const uint8_t *upper = coverage_row(r, y), *lower = coverage_row(r, y + TRAP_PX);
        const FlColumns span = fl_area_row(&r->area, y);
        for (int x = span.first; x + TRAP_PX < span.last; x++) {
            if (!holds_square(upper + x, lower + x))
                continue;
            const size_t other = top_of_square(edges->top, row + (size_t)x, width);
            edges->overlap[own * n + other] = edges->overlap[other * n + own] = true;
        }
    }
}

/** Where more of a draw is seen than of what was uppermost, it is that now. */
static void put_on_top(FlEdgeMap *edges, int draw)
{
    const FlDraw *r = &edges->draws->draw[draw];
    const int opacity = hiding(edges->input, r);
    for (int y = 0; opacity > 0 && y < r->area.box.height; y++) {
        const uint8_t *coverage = coverage_row(r, y);
        const size_t row = in_frame(edges, r->area.box, y);
        uint16_t *top = edges->top + row;
        uint8_t *hidden = edges->hidden + row;
        const FlColumns span = fl_area_row(&r->area, y);
        for (int x = span.first; x < span.last; x++) {
            if (coverage[x] < SHOWN)
                continue;
            const int below = hidden[x] * (255 - opacity) / 255;
            top[x] = opacity > below ? (uint16_t)(draw + 1) : top[x];
            hidden[x] = (uint8_t)MAX(opacity, below);
        }
    }
}

bool fl_edges_init(FlEdgeMap *edges, const FlComposeInput *input, const FlDrawList *draws,
                   GError **error)
{
    const size_t pixels =
        (size_t)fl_drawing_width(input->drawing) * (size_t)fl_drawing_height(input->drawing);
    *edges = (FlEdgeMap){.input = input, .draws = draws};
    edges->n = MIN(draws->n, MOST_DRAWS) + 1;
    const size_t pairs = (size_t)edges->n * (size_t)edges->n;
    if (!(edges->top = fl_alloc(pixels, sizeof *edges->top, "a matte", error)) ||
        !(edges->hidden = fl_alloc(pixels, 1, "a matte", error)) ||
        !(edges->overlap = fl_alloc(pairs, sizeof *edges->overlap, "a matte", error)))
        return false;
    for (int r = 0; r < edges->n - 1; r++) {
        note_overlaps(edges, r);
        put_on_top(edges, r);
    }
    return true;
}

void fl_edges_clear(FlEdgeMap *edges)
{
    free(edges->top);
    free(edges->hidden);
    free(edges->overlap);
    *edges = (FlEdgeMap){0};
}

/** A part of a draw's box that is closed by itself, and room for it. */
typedef struct Tile {
    FlRect part;                // what is closed, with what may change it
    FlRect around;              // with what the shares are of
    int16_t *amounts, *inside;  // of part
    uint8_t *share;             // of part: of the edges that are closed
    uint8_t *coverage, *others; // of around
} Tile;

/** What of a part of the frame a shape takes up; empty: nothing. */
static FlRect shape_in(const FlDraw *draw, FlRect part)
{
    const FlRect all = draw->area.box, both = fl_rect_and(part, all);
    FlRect box = fl_rect_within(draw->coverage, all.width,
                                (FlRect){both.x - all.x, both.y - all.y, both.width, both.height});
    box.x += all.x, box.y += all.y;
    return box;
}

static void tile_clear(Tile *tile)
{
    free(tile->amounts);
    free(tile->inside);
    free(tile->share);
    free(tile->coverage);
    free(tile->others);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Tile, tile_clear)

static bool tile_init(Tile *tile, const FlEdgeMap *edges, int draw, FlRect box, int radius_px,
                      GError **error)
{
    const FlRect frame = {0, 0, fl_drawing_width(edges->input->drawing),
                          fl_drawing_height(edges->input->drawing)};
    const FlRect part =
        shape_in(&edges->draws->draw[draw], fl_rect_grown(box, fl_closing_reach(radius_px), frame));
    *tile = (Tile){.part = part, .around = fl_rect_grown(part, radius_px, frame)};
    const size_t n = fl_rect_pixels(part), around = fl_rect_pixels(tile->around);
    return (tile->amounts = fl_alloc_unset(n, sizeof *tile->amounts, "a matte", error)) &&
           (tile->inside = fl_alloc_unset(n, sizeof *tile->inside, "a matte", error)) &&
           (tile->share = fl_alloc(n, 1, "a matte", error)) &&
           (tile->coverage = fl_alloc(around, 1, "a matte", error)) &&
           (tile->others = fl_alloc_unset(around, 1, "a matte", error));
}

/** Where the part is in what is around it. */
static FlRect part_of(const Tile *tile)
{
    const FlRect around = tile->around, part = tile->part;
    return (FlRect){part.x - around.x, part.y - around.y, part.width, part.height};
}

/** What hides counts by how much of a draw with an opacity it would. */
static void count_hidden(int alpha, uint8_t counts[256])
{
    for (int hidden = 0; hidden < 256; hidden++)
        counts[hidden] = (uint8_t)MIN(hidden * 255 / MAX(alpha, 1), 255);
}

/**
 * The share of the edges of a draw with those below or above which it does not lie. Others count by
 * how much they hide for one as opaque as the draw: a group that fades keeps its seams closed.
 */
static bool find_share(Tile *tile, const FlEdgeMap *edges, int draw, int radius_px, GError **error)
{
    const bool *overlap = edges->overlap + (size_t)(draw + 1) * (size_t)edges->n;
    const FlRect around = tile->around;
    uint8_t any = 0, counts[256];
    count_hidden(edges->draws->draw[draw].alpha, counts);
    for (int y = 0; y < around.height; y++) {
        const size_t first = in_frame(edges, around, y);
        const uint16_t *row = edges->top + first;
        const uint8_t *hidden = edges->hidden + first;
        uint8_t *others = tile->others + (size_t)y * (size_t)around.width;
        for (int x = 0, end; x < around.width; x = end) {
            end = fl_end_of_same(row, x, around.width);
            const bool other = row[x] && row[x] != draw + 1 && !overlap[row[x]];
            if (!other)
                memset(others + x, 0, (size_t)(end - x));
            for (int k = x; k < end && other; k++)
                any |= others[k] = counts[hidden[k]];
        }
    }
    return !any || fl_closing_share(tile->coverage, tile->others, around.width, around.height,
                                    part_of(tile), radius_px, tile->share, error);
}

static void fill_tile(Tile *tile, const FlDraw *draw, const int16_t *amounts)
{
    const FlRect all = draw->area.box, around = tile->around;
    fl_rect_copy(amounts, all, tile->amounts, tile->part, sizeof *tile->amounts);
    fl_rect_copy(draw->coverage, all, tile->coverage, around, 1);
    fl_closing_inside(tile->coverage, around.width, around.height, part_of(tile), tile->inside);
}

static bool close_tile(const FlEdgeMap *edges, int draw, FlRect box, int radius_px,
                       const int16_t *amounts, int16_t *closed, GError **error)
{
    g_auto(Tile) tile = {0};
    const FlRect all = edges->draws->draw[draw].area.box;
    if (!tile_init(&tile, edges, draw, box, radius_px, error))
        return false;
    fill_tile(&tile, &edges->draws->draw[draw], amounts);
    const FlRect part = tile.part;
    if (!find_share(&tile, edges, draw, radius_px, error) ||
        !fl_closing_apply(tile.amounts, tile.inside, tile.share, part, radius_px, error))
        return false;
    for (int y = box.y; y < box.y + box.height; y++)
        memcpy(closed + (size_t)(y - all.y) * (size_t)all.width + (box.x - all.x),
               tile.amounts + (size_t)(y - part.y) * (size_t)part.width + (box.x - part.x),
               (size_t)box.width * sizeof *closed);
    return true;
}

/** All tiles in which the shape is: many shapes are far smaller than their box. */
static bool close_tiles(const FlEdgeMap *edges, int draw, int radius_px, const int16_t *amounts,
                        int16_t *closed, GError **error)
{
    const FlRect all = edges->draws->draw[draw].area.box;
    const int columns = (all.width + TILE_PX - 1) / TILE_PX;
    const int rows = (all.height + TILE_PX - 1) / TILE_PX;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int t = 0; t < columns * rows; t++) {
        GError *failure = NULL;
        const FlRect corner = {all.x + t % columns * TILE_PX, all.y + t / columns * TILE_PX, 0, 0};
        const FlRect tile = {corner.x, corner.y, MIN(TILE_PX, all.x + all.width - corner.x),
                             MIN(TILE_PX, all.y + all.height - corner.y)};
        const FlRect box = shape_in(&edges->draws->draw[draw], tile);
        if (box.width > 0 && !close_tile(edges, draw, box, radius_px, amounts, closed, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

bool fl_edges_close(const FlEdgeMap *edges, int draw, const FlPaintedRegion *painted,
                    int16_t *amounts, GError **error)
{
    const FlRegionSettings *t = painted->settings;
    const size_t n = fl_rect_pixels(edges->draws->draw[draw].area.box);
    if (t->edges == FL_EDGES_SOFT || t->stacking == FL_STACKING_GLAZE || edges->input->gap_px > 0 ||
        n == 0 || draw >= edges->n - 1)
        return true;
    const float border = painted->style->border_px;
    const int radius = CLAMP((int)(border + 0.5f), 2, FL_CLOSING_MAX_PX);
    g_autofree int16_t *copy = fl_alloc_unset(n, sizeof *copy, "a layer", error);
    if (!copy)
        return false;
    memcpy(copy, amounts, n * sizeof *copy);
    return close_tiles(edges, draw, radius, copy, amounts, error);
}

/** 255 where a draw is all that is seen, else 0; of a box that may be larger than the draw's. */
static uint8_t *own_pixels(const FlEdgeMap *edges, int draw, FlRect box, GError **error)
{
    uint8_t *own = fl_alloc(fl_rect_pixels(box), 1, "a matte", error);
    const FlArea *area = &edges->draws->draw[draw].area;
    for (int y = 0; own && y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const uint8_t *coverage = coverage_row(&edges->draws->draw[draw], y);
        const uint16_t *top = edges->top + in_frame(edges, area->box, y);
        uint8_t *row = own + (size_t)(area->box.y + y - box.y) * (size_t)box.width;
        row += area->box.x - box.x;
        for (int x = span.first; x < span.last; x++)
            row[x] = coverage[x] == 255 && top[x] <= draw + 1 ? 255 : 0;
    }
    return own;
}

/** Counts the amounts of a draw deep enough inside what is seen of it. */
static bool count_inner(const FlEdgeMap *edges, int draw, const int16_t *amounts,
                        FlAmountCounts *counts, GError **error)
{
    enum { MARGIN_PX = 2 };
    const FlArea *area = &edges->draws->draw[draw].area;
    const FlRect frame = {0, 0, fl_drawing_width(edges->input->drawing),
                          fl_drawing_height(edges->input->drawing)};
    const FlRect box = fl_rect_grown(area->box, MARGIN_PX, frame);
    g_autofree uint8_t *inner = g_malloc((size_t)box.width);
    g_autofree uint8_t *own = own_pixels(edges, draw, box, error);
    for (int y = 0; own && y < area->box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        const int16_t *row = amounts + (size_t)y * (size_t)area->box.width;
        const uint8_t *within = inner + (area->box.x - box.x);
        fl_interior_row(own, box.width, box.height, area->box.y + y - box.y, MARGIN_PX, inner);
        for (int x = span.first; x < span.last; x++)
            if (within[x] == 255 && row[x] >= 0)
                counts->count[row[x]]++, counts->total++;
    }
    return own;
}

bool fl_edges_level(const FlEdgeMap *edges, int draw, int16_t *amounts, GError **error)
{
    const FlArea *area = &edges->draws->draw[draw].area;
    const FlRect box = area->box;
    g_autofree FlAmountCounts *counts = g_new0(FlAmountCounts, 1);
    if (!count_inner(edges, draw, amounts, counts, error))
        return false;
    const int exposure =
        CLAMP(fl_counts_exposure(counts), FL_EXPOSURE_ONE * 2 / 3, FL_EXPOSURE_ONE * 3 / 2);
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(area, y);
        int16_t *row = amounts + (size_t)y * box.width;
        for (int x = span.first; x < span.last; x++)
            if (row[x] > 0)
                row[x] = (int16_t)MIN(row[x] * exposure / FL_EXPOSURE_ONE, FL_AMOUNTS - 1);
    }
    return true;
}
