#include "job/surround.h"

#include "base/alloc.h"
#include "base/colour_difference.h"
#include "drawing/raster.h"
#include <string.h>

#define ALIKE 8.0f // CIE76: hardly another tone

struct FlSurround {
    int n_regions, width, height;
    FlMaskStore *together; // by region; empty: nothing is like it
    FlMaskStore *seen;     // by region; empty: nothing lies over it
    FlMaskStore *shown;    // of region 0
};

FlSurround *fl_surround_new(int n_regions, int n_frames, int width, int height, GError **error)
{
    g_autoptr(FlSurround) surround = g_new0(FlSurround, 1);
    *surround = (FlSurround){.n_regions = n_regions, .width = width, .height = height};
    if (!(surround->together = fl_mask_store_new(n_regions, n_frames, width, height, error)) ||
        !(surround->seen = fl_mask_store_new(n_regions, n_frames, width, height, error)) ||
        !(surround->shown = fl_mask_store_new(1, n_frames, width, height, error)))
        return NULL;
    return g_steal_pointer(&surround);
}

void fl_surround_free(FlSurround *surround)
{
    if (!surround)
        return;
    fl_mask_store_free(surround->together);
    fl_mask_store_free(surround->seen);
    fl_mask_store_free(surround->shown);
    g_free(surround);
}

static uint8_t coverage_at(const FlDraw *draw, int x, int y)
{
    const FlRect box = draw->area.box;
    return draw->coverage[(size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x)];
}

/** Adds a layer's colour at a pixel, if it has some there. */
static bool add_colour(const FlDraw *draw, int x, int y, uint64_t sum[3])
{
    const FlRect box = draw->area.box;
    const size_t p = (size_t)(y - box.y) * (size_t)box.width + (size_t)(x - box.x);
    for (int c = 0; c < 3; c++)
        sum[c] += draw->picture ? draw->picture[4 * p + (size_t)c] : draw->rgb[c];
    return true;
}

/** How far apart the mean colours of two draws are where both are: infinitely if they are nowhere.
 */
static float difference_where_they_meet(const FlDraw *a, const FlDraw *b)
{
    const FlRect both = fl_rect_and(a->area.box, b->area.box);
    uint64_t sum[2][3] = {{0}}, n = 0;
    for (int y = both.y; y < both.y + both.height; y++)
        for (int x = both.x; x < both.x + both.width; x++)
            if (coverage_at(a, x, y) && coverage_at(b, x, y))
                n += add_colour(a, x, y, sum[0]) && add_colour(b, x, y, sum[1]);
    uint8_t mean[2][3];
    for (int k = 0; k < 2 && n; k++)
        for (int c = 0; c < 3; c++)
            mean[k][c] = (uint8_t)((sum[k][c] + n / 2) / n);
    return n ? fl_colour_difference(mean[0], mean[1]) : 2 * ALIKE;
}

/** Whether no edge is seen between two draws: opaque, and of one colour. */
static bool alike(const FlDraw *a, const FlDraw *b)
{
    if (a->alpha != 255 || b->alpha != 255 || a->mix != FL_BLEND_MODE_OVER ||
        b->mix != FL_BLEND_MODE_OVER)
        return false;
    return a->picture || b->picture ? difference_where_they_meet(a, b) < ALIKE
                                    : fl_colour_difference(a->rgb, b->rgb) < ALIKE;
}

/** Whether a layer is not of the region, but like one of its draws. */
static bool joins_region(const FlDrawList *draws, const FlDraw *draw, int region,
                         const FlJoin *joins)
{
    if (draw->region == region || joins[draw->region] != FL_JOIN_ALIKE)
        return false;
    for (int r = 0; r < draws->n; r++)
        if (draws->draw[r].region == region && alike(&draws->draw[r], draw))
            return true;
    return false;
}

/** What is seen of a layer that others leave `free`, onto the coverage below. */
static void add_seen(const FlDraw *draw, const uint8_t *free_of, int width, uint8_t *coverage)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
        const size_t row = (size_t)(box.y + y) * (size_t)width + (size_t)box.x;
        for (int x = span.first; x < span.last; x++) {
            const size_t p = row + (size_t)x; // two halves of a pixel make a whole one
            coverage[p] = (uint8_t)MIN(coverage[p] + (from[x] * free_of[p] + 127) / 255, 255);
        }
    }
}

/** How far a layer counts as something that hides, 0..255: shading, through which edges are seen,
 * does not. */
static int opacity_of(const FlDraw *draw)
{
    return draw->mix == FL_BLEND_MODE_OVER ? MAX(5 * draw->alpha - 4 * 255, 0) : 0;
}

/** Takes a layer's share of what is free for those below it. */
static void hide_below(const FlDraw *draw, int width, uint8_t *free_of)
{
    const FlRect box = draw->area.box;
    const int opacity = opacity_of(draw);
    for (int y = 0; y < box.height && opacity > 0; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
        uint8_t *row = free_of + (size_t)(box.y + y) * (size_t)width + box.x;
        for (int x = span.first; x < span.last; x++)
            row[x] = (uint8_t)((row[x] * (255 * 255 - from[x] * opacity) + 32512) / 65025);
    }
}

/** Whether a layer of others lies over one of the region. */
static bool lies_below(const FlDrawList *draws, int region, const bool *like)
{
    for (int r = 0; r < draws->n; r++)
        for (int k = r + 1; k < draws->n && draws->draw[r].region == region; k++)
            if (draws->draw[k].region != region && !like[k] &&
                fl_rect_meet(draws->draw[r].area.box, draws->draw[k].area.box))
                return true;
    return false;
}

/** Room for planes of a frame. */
typedef struct Room {
    uint8_t *free_of, *coverage, *seen;
} Room;

/** The region with what is seen of those like it, and what is seen of it all. */
static bool put_region(FlSurround *surround, int frame, int region, const FlDrawList *draws,
                       const bool *like, bool any_like, const Room *room, GError **error)
{
    const size_t n = (size_t)surround->width * (size_t)surround->height;
    memset(room->free_of, 255, n);
    memset(room->seen, 0, n);
    fl_draw_list_mask(draws, region, surround->width, surround->height, room->coverage);
    for (int r = draws->n - 1; r >= 0; r--) {
        const FlDraw *draw = &draws->draw[r];
        if (like[r])
            add_seen(draw, room->free_of, surround->width, room->coverage);
        if (like[r] || draw->region == region)
            add_seen(draw, room->free_of, surround->width, room->seen);
        else
            hide_below(draw, surround->width, room->free_of);
    }
    return (!any_like ||
            fl_mask_store_put(surround->together, region, frame, room->coverage, error)) &&
           fl_mask_store_put(surround->seen, region, frame, room->seen, error);
}

/** Everything that hides what is below it. */
static bool put_shown(FlSurround *surround, int frame, const FlDrawList *draws, uint8_t *coverage,
                      GError **error)
{
    memset(coverage, 0, (size_t)surround->width * (size_t)surround->height);
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const int opacity = opacity_of(draw);
        for (int y = 0; y < draw->area.box.height && opacity > 0; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const FlRect box = draw->area.box;
            const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
            uint8_t *to = coverage + (size_t)(box.y + y) * (size_t)surround->width + box.x;
            for (int x = span.first; x < span.last; x++)
                to[x] = fl_over((uint8_t)(from[x] * opacity / 255), to[x]);
        }
    }
    return fl_mask_store_put(surround->shown, 0, frame, coverage, error);
}

bool fl_surround_put(FlSurround *surround, int frame, const FlDrawList *draws, const FlJoin *joins,
                     GError **error)
{
    const size_t n = (size_t)surround->width * (size_t)surround->height;
    g_autofree uint8_t *planes = fl_alloc(3 * n, 1, "masks", error);
    g_autofree bool *like = g_new0(bool, MAX(draws->n, 1));
    if (!planes || !put_shown(surround, frame, draws, planes, error))
        return false;
    const Room room = {planes, planes + n, planes + 2 * n};
    for (int region = 0; region < surround->n_regions; region++) {
        bool any = false;
        for (int r = 0; r < draws->n; r++)
            any |= like[r] = joins[region] == FL_JOIN_ALIKE &&
                             joins_region(draws, &draws->draw[r], region, joins);
        if (joins[region] != FL_JOIN_UNPAINTED && (any || lies_below(draws, region, like)) &&
            !put_region(surround, frame, region, draws, like, any, &room, error))
            return false;
    }
    return true;
}

bool fl_surround_joins_as_in(const FlSurround *surround, int region, int a, int b)
{
    return fl_mask_store_same(surround->together, region, a, b);
}

bool fl_surround_get(const FlSurround *surround, int region, int frame, FlRect part,
                     FlAround *around, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    *around = (FlAround){.joined = fl_mask_store_has(surround->together, region, frame),
                         .hidden = fl_mask_store_has(surround->seen, region, frame)};
    return (around->together = fl_alloc(n, 1, "a guide", error)) &&
           (around->seen = fl_alloc(n, 1, "a guide", error)) &&
           (around->shown = fl_alloc(n, 1, "a guide", error)) &&
           fl_mask_store_get(surround->together, region, frame, part, around->together, error) &&
           fl_mask_store_get(surround->seen, region, frame, part, around->seen, error) &&
           fl_mask_store_get(surround->shown, 0, frame, part, around->shown, error);
}

void fl_around_clear(FlAround *around)
{
    free(around->together);
    free(around->seen);
    free(around->shown);
    *around = (FlAround){0};
}
