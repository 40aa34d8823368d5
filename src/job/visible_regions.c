#include "job/visible_regions.h"

#include "base/alloc.h"
#include <string.h>

static bool is_seen(const bool *seen, int region)
{
    return __atomic_load_n(&seen[region], __ATOMIC_RELAXED);
}

static bool shows(const FlDraw *draw, const uint8_t *cover, int width)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *coverage = draw->coverage + (size_t)y * (size_t)box.width;
        const uint8_t *row = cover + (size_t)(box.y + y) * (size_t)width + box.x;
        for (int x = span.first; x < span.last; x++)
            if (coverage[x] && !row[x])
                return true;
    }
    return false;
}

/* Columns of a row with nothing but full pixels within reach of them; beyond the frame's sides all
 * are full. */
static void find_full(const uint8_t *coverage, FlRect box, int width, int reach, uint8_t *full)
{
    const int end = box.x + box.width == width ? box.width + reach : box.width;
    int run = box.x == 0 ? reach : 0;
    memset(full, 0, (size_t)box.width);
    for (int x = 0; x < end; x++) {
        run = x >= box.width || coverage[x] == 255 ? run + 1 : 0;
        if (x >= reach)
            full[x - reach] = run > 2 * reach;
    }
}

/* Marks where a shape hides all that is below it. run, full: scratch of its box's width. */
static void add_cover(const FlVisibleRegions *visible, const FlDraw *draw, int *run, uint8_t *full,
                      uint8_t *cover)
{
    const FlRect box = draw->area.box;
    const int reach = visible->rim_px;
    const int end = box.y + box.height == visible->height ? box.height + reach : box.height;
    for (int x = 0; x < box.width; x++)
        run[x] = box.y == 0 ? reach : 0;
    memset(full, 1, (size_t)box.width);
    for (int y = 0; y < end; y++) {
        uint8_t *row = cover + (box.y + y - reach) * (ptrdiff_t)visible->width + box.x;
        if (y < box.height)
            find_full(draw->coverage + (size_t)y * (size_t)box.width, box, visible->width, reach,
                      full);
        else
            memset(full, 1, (size_t)box.width);
        for (int x = 0; x < box.width; x++) {
            run[x] = full[x] ? run[x] + 1 : 0;
        }
        for (int x = 0; x < box.width && y >= reach; x++)
            row[x] |= run[x] > 2 * reach;
    }
}

static bool hides(const FlVisibleRegions *visible, const FlDraw *draw)
{
    return draw->alpha == 255 && draw->blend_mode == FL_BLEND_MODE_OVER &&
           visible->joins[draw->region] == FL_JOIN_CLOSED;
}

/* How many draws, from the bottom, there are up to the last one that is not known to be seen. */
static int draws_in_question(const FlDrawList *draws, const bool *seen)
{
    int n = 0;
    for (int r = 0; r < draws->n; r++)
        if (!is_seen(seen, draws->draw[r].region))
            n = r + 1;
    return n;
}

bool fl_visible_regions_note(const FlVisibleRegions *visible, const FlDrawList *draws, bool *seen,
                             GError **error)
{
    if (draws_in_question(draws, seen) == 0)
        return true;
    const size_t width = (size_t)visible->width;
    g_autofree uint8_t *cover = fl_alloc(width * (size_t)visible->height, 1, "a mask", error);
    g_autofree int *run = cover ? fl_alloc(width, sizeof *run, "a row of a mask", error) : NULL;
    g_autofree uint8_t *full = run ? fl_alloc(width, 1, "a row of a mask", error) : NULL;
    if (!full)
        return false;
    for (int r = draws->n - 1; r >= 0; r--) {
        const FlDraw *draw = &draws->draw[r];
        if (!is_seen(seen, draw->region) && shows(draw, cover, visible->width))
            __atomic_store_n(&seen[draw->region], true, __ATOMIC_RELAXED);
        if (hides(visible, draw))
            add_cover(visible, draw, run, full, cover);
    }
    return true;
}
