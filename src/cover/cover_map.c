#include "cover/cover_map.h"

#include "base/alloc.h"

#include <string.h>

static void hide_run(const uint8_t *coverage, int opacity, uint8_t *restrict free_of, int n)
{
    for (int x = 0; x < n; x++) {
        const uint16_t covered = (uint16_t)((coverage[x] * opacity + 127) / 255);
        free_of[x] = (uint8_t)((free_of[x] * (255 - covered) + 127) / 255);
    }
}

/** The index, in a part of the frame, of column 0 of row y of a box. */
static ptrdiff_t in_part(FlRect box, FlRect part, int y)
{
    return (ptrdiff_t)(box.y + y - part.y) * part.width + (box.x - part.x);
}

/** The columns of row y of a shape's box that lie within a part of the frame. */
static FlColumns columns_in(const FlArea *area, FlRect part, int y)
{
    const FlColumns span = fl_area_row(area, y);
    const int left = part.x - area->box.x;
    return (FlColumns){MAX(span.first, left), MIN(span.last, left + part.width)};
}

static const uint8_t *coverage_row(const FlDraw *draw, int y)
{
    return draw->coverage + (size_t)y * (size_t)draw->area.box.width;
}

void fl_cover_hide(const FlArea *area, const uint8_t *coverage, int opacity, FlRect part,
                   uint8_t *free_of)
{
    const FlRect box = area->box, both = fl_rect_and(box, part);
    for (int y = both.y - box.y; y < both.y + both.height - box.y && opacity > 0; y++) {
        const FlColumns span = columns_in(area, part, y);
        const uint8_t *row = coverage + (size_t)y * (size_t)box.width;
        uint8_t *below = free_of + in_part(box, part, y);
        for (FlColumns run = fl_next_run(row, span.first, span.last); run.first < run.last;
             run = fl_next_run(row, run.last, span.last))
            hide_run(row + run.first, opacity, below + run.first, run.last - run.first);
    }
}

/** Columns of a row all pixels of which within rim_px are full; beyond the page all are full. */
static void find_full(const uint8_t *coverage, FlRect box, int page_width, int rim_px,
                      uint8_t *full)
{
    const int end = box.x + box.width == page_width ? box.width + rim_px : box.width;
    int run = box.x == 0 ? rim_px : 0;
    memset(full, 0, (size_t)box.width);
    for (int x = 0; x < end; x++) {
        run = x >= box.width || coverage[x] == 255 ? run + 1 : 0;
        if (x >= rim_px)
            full[x - rim_px] = run > 2 * rim_px ? 255 : 0;
    }
}

/** A draw without its rim: 255 at pixels around which all within rim_px is full, else 0. */
static uint8_t *core_of(const FlDraw *draw, FlRect page, int rim_px, GError **error)
{
    const FlRect box = draw->area.box;
    const int end = box.y + box.height == page.height ? box.height + rim_px : box.height;
    uint8_t *core = fl_alloc(fl_rect_pixels(box), 1, "a matte", error);
    g_autofree int *run = g_new(int, MAX(box.width, 1));
    g_autofree uint8_t *full = g_malloc((size_t)MAX(box.width, 1));
    for (int x = 0; x < box.width; x++)
        run[x] = box.y == 0 ? rim_px : 0;
    memset(full, 255, (size_t)box.width);
    for (int y = 0; core && y < end; y++) {
        if (y < box.height)
            find_full(coverage_row(draw, y), box, page.width, rim_px, full);
        else
            memset(full, 255, (size_t)box.width);
        for (int x = 0; x < box.width; x++) {
            run[x] = full[x] ? run[x] + 1 : 0;
            if (y >= rim_px)
                core[(size_t)(y - rim_px) * (size_t)box.width + (size_t)x] =
                    run[x] > 2 * rim_px ? 255 : 0;
        }
    }
    return core;
}

/** Takes a draw out of what is free of the frame. */
static bool hide_below(const FlDraw *draw, FlHiding hiding, FlRect page, uint8_t *free_of,
                       GError **error)
{
    if (hiding.sheer && hiding.sheer[draw->region])
        return true;
    if (hiding.rim_px == 0) {
        fl_cover_hide(&draw->area, draw->coverage, fl_opacity(draw), page, free_of);
        return true;
    }
    g_autofree uint8_t *core = core_of(draw, page, hiding.rim_px, error);
    if (core)
        fl_cover_hide(&draw->area, core, fl_opacity(draw), page, free_of);
    return core;
}

/** Returns: true if a draw lies below another one. */
static bool is_below(const FlDraw *draw, const uint8_t *free_of, FlRect page)
{
    uint8_t any = 0;
    for (int y = 0; y < draw->area.box.height && !any; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *row = free_of + in_part(draw->area.box, page, y);
        const uint8_t *coverage = coverage_row(draw, y);
        for (int x = span.first; x < span.last; x++)
            any |= coverage[x] & (uint8_t)~row[x];
    }
    return any;
}

/** The visible share of a draw of which some is hidden. */
static uint8_t *share_of(const FlDraw *draw, const uint8_t *free_of, FlRect page, GError **error)
{
    const FlRect box = draw->area.box;
    uint8_t *share = fl_alloc(fl_rect_pixels(box), 1, "a matte", error);
    for (int y = 0; share && y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *row = free_of + in_part(box, page, y);
        const uint8_t *coverage = coverage_row(draw, y);
        uint8_t *restrict to = share + (size_t)y * (size_t)box.width;
        for (int x = span.first; x < span.last; x++)
            to[x] = (uint8_t)((coverage[x] * row[x] + 127) / 255);
    }
    return share;
}

bool fl_cover_init(FlCover *cover, const FlDrawList *draws, int width, int height, FlHiding hiding,
                   GError **error)
{
    const FlRect page = {0, 0, width, height};
    *cover = (FlCover){.draws = draws, .width = width, .height = height};
    if (!(cover->free = fl_alloc_unset(fl_rect_pixels(page), 1, "a matte", error)))
        return false;
    memset(cover->free, 255, fl_rect_pixels(page));
    cover->share = g_new0(uint8_t *, MAX(draws->n, 1));
    for (int r = draws->n - 1; r >= 0; r--) {
        const FlDraw *draw = &draws->draw[r];
        cover->share[r] = is_below(draw, cover->free, page)
                              ? share_of(draw, cover->free, page, error)
                              : draw->coverage;
        const bool empty = fl_rect_pixels(draw->area.box) == 0;
        if (!empty && (!cover->share[r] || !hide_below(draw, hiding, page, cover->free, error)))
            return false;
    }
    return true;
}

void fl_cover_clear(FlCover *cover)
{
    for (int r = 0; cover->share && r < cover->draws->n; r++)
        if (cover->share[r] != cover->draws->draw[r].coverage)
            free(cover->share[r]);
    g_free(cover->share);
    free(cover->free);
    *cover = (FlCover){0};
}

FlRect fl_cover_of_region(const FlCover *cover, int region, FlRect part, uint8_t *share)
{
    FlRect around = {0, 0, 0, 0};
    memset(share, 0, fl_rect_pixels(part));
    for (int r = 0; r < cover->draws->n; r++) {
        const FlDraw *draw = &cover->draws->draw[r];
        const FlRect box = draw->area.box, both = fl_rect_and(box, part);
        if (draw->region != region)
            continue;
        around = fl_rect_or(around, both);
        for (int y = both.y - box.y; y < both.y + both.height - box.y; y++) {
            const FlColumns span = columns_in(&draw->area, part, y);
            const uint8_t *from = fl_cover_row(cover, r, y);
            uint8_t *to = share + in_part(box, part, y);
            for (int x = span.first; x < span.last; x++)
                to[x] = (uint8_t)MIN(to[x] + from[x], 255);
        }
    }
    return around;
}

bool fl_cover_note_seen(const FlDrawList *draws, int width, int height, FlHiding hiding, bool *seen,
                        GError **error)
{
    g_auto(FlCover) cover = {0};
    bool known = true;
    for (int r = 0; r < draws->n; r++)
        known &= __atomic_load_n(&seen[draws->draw[r].region], __ATOMIC_RELAXED);
    if (known)
        return true;
    if (!fl_cover_init(&cover, draws, width, height, hiding, error))
        return false;
    for (int r = 0; r < draws->n; r++)
        if (!fl_is_blank(cover.share[r], fl_rect_pixels(draws->draw[r].area.box)))
            __atomic_store_n(&seen[draws->draw[r].region], true, __ATOMIC_RELAXED);
    return true;
}
