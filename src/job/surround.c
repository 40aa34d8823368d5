#include "job/surround.h"

#include "base/alloc.h"
#include "base/windows.h"
#include "worker/raster.h"
#include <string.h>

#define REACH 24 // a shape counts this share of the larger side around what is seen of it

struct FlSurround {
    int n_regions, width, height;
    FlMaskStore *together; // by region; empty: nothing is like it
    FlMaskStore *closed;   // by region, near to it; empty: nothing is beside it
    FlMaskStore *seen;     // by region; empty: nothing lies over it
    FlMaskStore *shown;    // of region 0
};

FlSurround *fl_surround_new(int n_regions, int n_frames, int width, int height, GError **error)
{
    g_autoptr(FlSurround) surround = g_new0(FlSurround, 1);
    *surround = (FlSurround){.n_regions = n_regions, .width = width, .height = height};
    if (!(surround->together = fl_mask_store_new(n_regions, n_frames, width, height, error)) ||
        !(surround->closed = fl_mask_store_new(n_regions, n_frames, width, height, error)) ||
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
    fl_mask_store_free(surround->closed);
    fl_mask_store_free(surround->seen);
    fl_mask_store_free(surround->shown);
    g_free(surround);
}

/** What is seen of a layer that others leave `free`, onto the coverage below. */
static void add_seen(const FlDraw *draw, const uint8_t *free_of, int width, uint8_t *coverage)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
        const size_t row = (size_t)(box.y + y) * (size_t)width + (size_t)box.x;
        const uint8_t *free_there = free_of + row;
        uint8_t *restrict to = coverage + row;
        for (FlColumns run = fl_next_run(from, span.first, span.last); run.first < run.last;
             run = fl_next_run(from, run.last, span.last))
            for (int x = run.first; x < run.last; x++) { // two halves of a pixel make a whole one
                const uint8_t seen = (uint8_t)((from[x] * free_there[x] + 127) / 255);
                to[x] = (uint8_t)MIN(to[x] + seen, 255);
            }
    }
}

/** How far a layer counts as something that hides, 0..255: shading, through which edges are seen,
 * does not. */
static int opacity_of(const FlDraw *draw)
{
    return draw->blend_mode == FL_BLEND_MODE_OVER ? MAX(5 * draw->alpha - 4 * 255, 0) : 0;
}

/** What n coverages of an opaque layer leave free. */
static void keep_free(const uint8_t *coverage, uint8_t *restrict free_of, int n)
{
    for (int x = 0; x < n; x++)
        free_of[x] = (uint8_t)((free_of[x] * (255 - coverage[x]) + 127) / 255);
}

/** The same of one with an opacity. */
static void keep_part_free(const uint8_t *coverage, int opacity, uint8_t *restrict free_of, int n)
{
    for (int x = 0; x < n; x++)
        free_of[x] =
            (uint8_t)((free_of[x] * (255 * 255 - coverage[x] * opacity) + 32512) / (255 * 255));
}

/** Takes a layer's share of what is free for those below it, within a part of the frame. */
static void hide_below(const FlDraw *draw, FlRect within, int width, uint8_t *free_of)
{
    const FlRect box = draw->area.box, part = fl_rect_and(box, within);
    const int opacity = opacity_of(draw);
    for (int y = part.y - box.y; y < part.y + part.height - box.y && opacity > 0; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const int first = MAX(span.first, part.x - box.x);
        const int last = MIN(span.last, part.x + part.width - box.x);
        const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
        uint8_t *row = free_of + (size_t)(box.y + y) * (size_t)width + box.x;
        for (FlColumns run = fl_next_run(from, first, last); run.first < run.last;
             run = fl_next_run(from, run.last, last))
            if (opacity == 255)
                keep_free(from + run.first, row + run.first, run.last - run.first);
            else
                keep_part_free(from + run.first, opacity, row + run.first, run.last - run.first);
    }
}

/** Whether a layer of others lies over one of the region. */
static bool lies_below(const FlDrawList *draws, int region, const FlSharing *sharing)
{
    for (int r = 0; r < draws->n; r++)
        for (int k = r + 1; k < draws->n && draws->draw[r].region == region; k++)
            if (draws->draw[k].region != region && sharing[k] != FL_SHARING_ALIKE &&
                fl_rect_meet(draws->draw[r].area.box, draws->draw[k].area.box))
                return true;
    return false;
}

/** What is asked of a draw. */
typedef struct Wanted {
    bool shares; // it is of the colour of another region
    bool seen;   // it is all that is together with its region, and what is seen of it is stored
} Wanted;

/** A frame, and room for planes of it. */
typedef struct Frame {
    const FlDrawList *draws;
    int number;
    Wanted *wanted;      // by draw
    uint8_t **near_seen; // by draw: its coverage near to where it is seen; NULL: not needed
    uint8_t *free_of;
    uint8_t *coverage; // 0, but for what is made of it between two masks that are stored
} Frame;

/** The same of a plane of the draw's box. */
static void add_coverage(const FlDraw *draw, const uint8_t *plane, int width, uint8_t *coverage)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const FlColumns span = fl_area_row(&draw->area, y);
        const uint8_t *from = plane + (size_t)y * (size_t)box.width;
        uint8_t *restrict to = coverage + (size_t)(box.y + y) * (size_t)width + box.x;
        for (int x = span.first; x < span.last; x++)
            to[x] = (uint8_t)MIN(to[x] + from[x], 255);
    }
}

/**
 * The coverage of a draw as far as it is seen within reach_px: a neck goes on below a collar. The
 * less of it is seen there the less it counts, so that nothing comes or goes at once.
 */
static uint8_t *near_seen(const FlDraw *draw, const uint8_t *free_of, int width, int reach_px,
                          GError **error)
{
    const FlRect box = draw->area.box;
    const size_t n = fl_rect_pixels(box);
    g_autofree int16_t *seen = fl_alloc_unset(n, sizeof *seen, "a mask", error);
    g_autofree uint32_t *sums = seen ? fl_alloc_unset(n, sizeof *sums, "a mask", error) : NULL;
    uint8_t *near = sums ? fl_alloc_unset(n, 1, "a mask", error) : NULL;
    if (!near)
        return NULL;
    for (int y = 0; y < box.height; y++) {
        const uint8_t *free_there = free_of + (size_t)(box.y + y) * (size_t)width + box.x;
        const size_t row = (size_t)y * (size_t)box.width;
        for (int x = 0; x < box.width; x++)
            seen[row + (size_t)x] =
                (int16_t)((draw->coverage[row + (size_t)x] * free_there[x] + 127) / 255);
    }
    fl_window_sums(seen, box, reach_px, sums);
    const uint32_t side = (uint32_t)(2 * reach_px + 1);
    for (size_t p = 0; p < n; p++) { // a line of pixels that crosses the window is enough
        const uint32_t share = sums[p] < 255 * side ? sums[p] / side : 255;
        near[p] = (uint8_t)MAX(seen[p], (int)(draw->coverage[p] * share / 255));
    }
    return near;
}

static int reach_of(const FlSurround *surround)
{
    return MAX(MAX(surround->width, surround->height) / REACH, 1);
}

/** Onto the coverage, the draws of the region's colour. Returns: the rectangle around them. */
static FlRect add_alike(const FlSurround *surround, const Frame *frame, const FlSharing *sharing)
{
    FlRect around = {0, 0, 0, 0};
    for (int r = 0; r < frame->draws->n; r++)
        if (sharing[r] == FL_SHARING_ALIKE && frame->near_seen[r]) {
            add_coverage(&frame->draws->draw[r], frame->near_seen[r], surround->width,
                         frame->coverage);
            around = fl_rect_or(around, frame->draws->draw[r].area.box);
        }
    return around;
}

/** What of a frame the rim of the region in `own` may depend on: more than three borders around
 * it. */
static FlRect near_region(const FlSurround *surround, const Frame *frame, FlRect own)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    const FlRect box = fl_rect_within(frame->coverage, page.width, own);
    return box.width > 0 ? fl_rect_grown(box, 4 * reach_of(surround), page) : box;
}

/**
 * Onto the coverage, what borders on the region, near to it. Hidden or not: what crosses a
 * neighbour gives a shape at rest no other rim, and none is missed when it has passed. Returns:
 * whether anything does.
 */
static bool add_bordering(const FlSurround *surround, const Frame *frame, const FlSharing *sharing,
                          FlRect near)
{
    bool any = false;
    for (int r = 0; r < frame->draws->n; r++) {
        const FlDraw *draw = &frame->draws->draw[r];
        const FlRect box = draw->area.box, part = fl_rect_and(box, near);
        if (sharing[r] != FL_SHARING_BESIDE)
            continue;
        for (int y = part.y; y < part.y + part.height; y++) {
            const uint8_t *from = draw->coverage + (size_t)(y - box.y) * (size_t)box.width;
            uint8_t *to = frame->coverage + (size_t)y * (size_t)surround->width;
            for (int x = part.x; x < part.x + part.width; x++)
                to[x] = (uint8_t)MIN(to[x] + from[x - box.x], 255);
        }
        any |= part.width > 0;
    }
    return any;
}

/** Whether a draw is of the region or of its colour. */
static bool is_together(const FlDraw *draw, int region, FlSharing sharing)
{
    return sharing == FL_SHARING_ALIKE || draw->region == region;
}

/** The rectangle around a region and those of its colour. */
static FlRect around_together(const FlDrawList *draws, int region, const FlSharing *sharing)
{
    FlRect around = {0, 0, 0, 0};
    for (int r = 0; r < draws->n; r++)
        if (is_together(&draws->draw[r], region, sharing[r]))
            around = fl_rect_or(around, draws->draw[r].area.box);
    return around;
}

/** What is seen of a region and those of its colour, which `around` holds. What is free is found
 * there only. */
static void find_seen(const FlSurround *surround, int region, const Frame *frame, FlRect around,
                      const FlSharing *sharing)
{
    const size_t width = (size_t)surround->width;
    for (int y = around.y; y < around.y + around.height; y++)
        memset(frame->free_of + (size_t)y * width + around.x, 255, (size_t)around.width);
    for (int r = frame->draws->n - 1; r >= 0; r--) {
        const FlDraw *draw = &frame->draws->draw[r];
        if (is_together(draw, region, sharing[r]))
            add_seen(draw, frame->free_of, surround->width, frame->coverage);
        else
            hide_below(draw, around, surround->width, frame->free_of);
    }
}

/** The region with those that share its edges. */
static bool put_shared(FlSurround *surround, int region, const Frame *frame,
                       const FlSharing *sharing, GError **error)
{
    uint8_t *coverage = frame->coverage;
    const FlRect own =
        fl_draw_list_put_mask(frame->draws, region, surround->width, surround->height, coverage);
    const FlRect near = near_region(surround, frame, own);
    const FlRect alike = add_alike(surround, frame, sharing), both = fl_rect_or(own, alike);
    if (alike.width > 0 &&
        !fl_mask_store_put_part(surround->together, region, frame->number, coverage, both, error))
        return false;
    const FlRect all = fl_rect_or(both, near);
    if (add_bordering(surround, frame, sharing, near) &&
        !fl_mask_store_put_part(surround->closed, region, frame->number, coverage, all, error))
        return false;
    fl_rect_clear(coverage, surround->width, all);
    return true;
}

/** What is seen of a region and those of its colour. */
static bool put_seen(FlSurround *surround, int region, const Frame *frame, const FlSharing *sharing,
                     GError **error)
{
    const FlRect around = around_together(frame->draws, region, sharing);
    find_seen(surround, region, frame, around, sharing);
    if (!fl_mask_store_put_part(surround->seen, region, frame->number, frame->coverage, around,
                                error))
        return false;
    fl_rect_clear(frame->coverage, surround->width, around);
    return true;
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
            for (FlColumns run = fl_next_run(from, span.first, span.last); run.first < run.last;
                 run = fl_next_run(from, run.last, span.last))
                for (int x = run.first; x < run.last; x++)
                    to[x] = fl_over((uint8_t)(from[x] * opacity / 255), to[x]);
        }
    }
    return fl_mask_store_put(surround->shown, 0, frame, coverage, error);
}

/** Notes how each draw shares the region's edges. Returns: whether any does. */
static bool find_sharing(const FlDrawList *draws, int region, const FlJoin *joins,
                         const FlSharedEdges *edges, FlSharing *sharing)
{
    bool any = false;
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const bool opaque = draw->alpha == 255 && draw->blend_mode == FL_BLEND_MODE_OVER;
        sharing[r] =
            opaque ? fl_shared_edges_get(edges, region, draw->region, joins) : FL_SHARING_NONE;
        any |= sharing[r] != FL_SHARING_NONE;
    }
    return any;
}

/** Whether what is around a region is asked for. */
static bool is_wanted(int region, const FlJoin *joins, const int *painted_of)
{
    return joins[region] != FL_JOIN_UNPAINTED && (!painted_of || painted_of[region] >= 0);
}

/** What is seen of a draw, where others leave `free_of`. */
static bool put_seen_alone(FlSurround *surround, const Frame *frame, const FlDraw *draw,
                           GError **error)
{
    add_seen(draw, frame->free_of, surround->width, frame->coverage);
    if (!fl_mask_store_put_part(surround->seen, draw->region, frame->number, frame->coverage,
                                draw->area.box, error))
        return false;
    fl_rect_clear(frame->coverage, surround->width, draw->area.box);
    return true;
}

/** From the top down, what is wanted of each draw. */
static bool put_draws(FlSurround *surround, const Frame *frame, GError **error)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    memset(frame->free_of, 255, fl_rect_pixels(page));
    for (int r = frame->draws->n - 1; r >= 0; r--) {
        const FlDraw *draw = &frame->draws->draw[r];
        const Wanted wanted = frame->wanted[r];
        if (wanted.shares && fl_rect_pixels(draw->area.box) > 0 &&
            !(frame->near_seen[r] =
                  near_seen(draw, frame->free_of, surround->width, reach_of(surround), error)))
            return false;
        if (wanted.seen && !put_seen_alone(surround, frame, draw, error))
            return false;
        hide_below(draw, page, surround->width, frame->free_of);
    }
    return true;
}

/** Whether all that is together with a region is one draw, which is then wanted by itself. */
static bool is_alone(const Frame *frame, int region, const FlSharing *sharing)
{
    int n = 0;
    for (int r = 0; r < frame->draws->n; r++)
        n += is_together(&frame->draws->draw[r], region, sharing[r]);
    return n == 1;
}

static bool put_regions(FlSurround *surround, const Frame *frame, const FlJoin *joins,
                        const int *painted_of, const FlSharedEdges *edges, GError **error)
{
    const FlDrawList *draws = frame->draws;
    g_autofree FlSharing *sharing = g_new0(FlSharing, MAX(draws->n, 1));
    for (int region = 0; region < surround->n_regions; region++) {
        if (!is_wanted(region, joins, painted_of))
            continue;
        const bool any = find_sharing(draws, region, joins, edges, sharing);
        if (!any && !lies_below(draws, region, sharing))
            continue;
        if (!put_shared(surround, region, frame, sharing, error) ||
            (!is_alone(frame, region, sharing) &&
             !put_seen(surround, region, frame, sharing, error)))
            return false;
    }
    return true;
}

/** Marks what regions want of the draws. */
static void find_wanted(const FlSurround *surround, const Frame *frame, const FlJoin *joins,
                        const int *painted_of, const FlSharedEdges *edges)
{
    const FlDrawList *draws = frame->draws;
    g_autofree FlSharing *sharing = g_new0(FlSharing, MAX(draws->n, 1));
    for (int region = 0; region < surround->n_regions; region++) {
        if (!is_wanted(region, joins, painted_of))
            continue;
        const bool any = find_sharing(draws, region, joins, edges, sharing);
        const bool alone =
            (any || lies_below(draws, region, sharing)) && is_alone(frame, region, sharing);
        for (int r = 0; r < draws->n; r++) {
            frame->wanted[r].shares |= sharing[r] == FL_SHARING_ALIKE;
            frame->wanted[r].seen |= alone && draws->draw[r].region == region;
        }
    }
}

bool fl_surround_put(FlSurround *surround, int frame, const FlDrawList *draws, const FlJoin *joins,
                     const int *painted_of, const FlSharedEdges *edges, GError **error)
{
    const size_t n = (size_t)surround->width * (size_t)surround->height;
    g_autofree uint8_t *planes = fl_alloc(2 * n, 1, "masks", error);
    g_autofree Wanted *wanted = g_new0(Wanted, MAX(draws->n, 1));
    g_autofree uint8_t **near = g_new0(uint8_t *, MAX(draws->n, 1));
    const Frame all = {draws, frame, wanted, near, planes, planes + n};
    find_wanted(surround, &all, joins, painted_of, edges);
    const bool done = planes && put_shown(surround, frame, draws, all.free_of, error) &&
                      put_draws(surround, &all, error) &&
                      put_regions(surround, &all, joins, painted_of, edges, error);
    for (int r = 0; r < draws->n; r++)
        free(near[r]);
    return done;
}

bool fl_surround_joins(const FlSurround *surround, int region, int frame)
{
    return fl_mask_store_has(surround->together, region, frame) ||
           fl_mask_store_has(surround->closed, region, frame);
}

bool fl_surround_joins_as_in(const FlSurround *surround, int region, int a, int b)
{
    return fl_mask_store_same(surround->together, region, a, b) &&
           fl_mask_store_same(surround->closed, region, a, b);
}

/* Adds where the masks of a store differ; scratch: two masks of `part`. */
static bool add_difference(const FlMaskStore *masks, int region, int a, int b, FlRect part,
                           uint8_t *scratch, uint8_t *differs, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    if (fl_mask_store_same(masks, region, a, b))
        return true;
    if (!fl_mask_store_get(masks, region, a, part, scratch, error) ||
        !fl_mask_store_get(masks, region, b, part, scratch + n, error))
        return false;
    for (size_t p = 0; p < n; p++)
        differs[p] |= scratch[p] ^ scratch[n + p];
    return true;
}

bool fl_surround_differs(const FlSurround *surround, int region, int a, int b, FlRect part,
                         uint8_t *differs, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    g_autofree uint8_t *scratch = fl_alloc_unset(2 * n, 1, "a mask", error);
    memset(differs, 0, n);
    return scratch &&
           add_difference(surround->together, region, a, b, part, scratch, differs, error) &&
           add_difference(surround->closed, region, a, b, part, scratch, differs, error);
}

bool fl_surround_get(const FlSurround *surround, int region, int frame, FlRect part,
                     FlSurroundPlanes *around, GError **error)
{
    const size_t n = fl_rect_pixels(part);
    *around = (FlSurroundPlanes){.joined = fl_mask_store_has(surround->together, region, frame),
                                 .bordered = fl_mask_store_has(surround->closed, region, frame),
                                 .hidden = fl_mask_store_has(surround->seen, region, frame)};
    return (around->together = fl_alloc(n, 1, "a guide", error)) &&
           (around->closed = fl_alloc(n, 1, "a guide", error)) &&
           (around->seen = fl_alloc(n, 1, "a guide", error)) &&
           (around->shown = fl_alloc(n, 1, "a guide", error)) &&
           fl_mask_store_get(surround->together, region, frame, part, around->together, error) &&
           fl_mask_store_get(surround->closed, region, frame, part, around->closed, error) &&
           fl_mask_store_get(surround->seen, region, frame, part, around->seen, error) &&
           fl_mask_store_get(surround->shown, 0, frame, part, around->shown, error);
}

void fl_surround_planes_clear(FlSurroundPlanes *around)
{
    free(around->together);
    free(around->closed);
    free(around->seen);
    free(around->shown);
    *around = (FlSurroundPlanes){0};
}
