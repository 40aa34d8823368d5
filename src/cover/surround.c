#include "cover/surround.h"

#include "base/alloc.h"
#include "base/windows.h"
#include "cover/cover_map.h"
#include <string.h>

#define REACH 24 // a shape counts this share of the larger side around its visible part

/** The planes of a region; those of the whole frame follow those of all regions: the shares that
 * all shapes cover, and both bytes of the lowest figures. */
typedef enum Kind {
    MASK,     // its coverage
    TOGETHER, // blank: no other shape has its colour
    CLOSED,   // near the region; blank: no neighbours
    SEEN,     // blank: the region is not covered
    N_KINDS,
} Kind;

/** The mean opacity of the shapes that share a region's edges, 0..255. */
typedef struct Weights {
    uint8_t together, closed;
} Weights;

struct FlSurround {
    int n_regions, n_frames, width, height;
    FlMaskStore *planes; // plane_of()
    Weights *weights;    // [region * n_frames + frame]
};

static int plane_of(const FlSurround *surround, Kind kind, int region)
{
    return kind * surround->n_regions + region;
}

/** The plane of what all shapes cover. */
static int shown_plane(const FlSurround *surround)
{
    return N_KINDS * surround->n_regions;
}

/** The plane of byte k of the lowest figures. */
static int lowest_plane(const FlSurround *surround, int k)
{
    return shown_plane(surround) + 1 + k;
}

static Weights *weights_of(const FlSurround *surround, int region, int frame)
{
    return &surround->weights[(size_t)region * (size_t)surround->n_frames + (size_t)frame];
}

FlSurround *fl_surround_new(int n_regions, int n_frames, int width, int height, GError **error)
{
    FlMaskStore *planes =
        fl_mask_store_new(N_KINDS * n_regions + 3, n_frames, width, height, error);
    if (!planes)
        return NULL;
    FlSurround *surround = g_new0(FlSurround, 1);
    *surround = (FlSurround){
        n_regions, n_frames, width,
        height,    planes,   g_new0(Weights, (size_t)MAX(n_regions, 1) * (size_t)n_frames)};
    return surround;
}

void fl_surround_free(FlSurround *surround)
{
    if (!surround)
        return;
    fl_mask_store_free(surround->planes);
    g_free(surround->weights);
    g_free(surround);
}

FlMaskStore *fl_surround_masks(const FlSurround *surround)
{
    return surround->planes;
}

/** A frame, and room for one plane. */
typedef struct Frame {
    const FlDrawList *draws;
    const FlCover *cover;
    int number;
    uint8_t **near;    // by draw: its coverage near to where it is seen; NULL: not needed yet
    uint8_t *coverage; // 0, but for what is made of it between two masks that are stored
} Frame;

/** A region in a frame. */
typedef struct Region {
    int number;
    FlRect box;
    int opacity;        // the greatest of its draws
    const FlEdge *edge; // that it has with each draw
} Region;

/** A mean opacity, weighed by coverage. */
typedef struct Share {
    uint64_t there, all;
} Share;

static uint8_t weight_of(const Share *share)
{
    return (uint8_t)(share->all ? (share->there + share->all / 2) / share->all : 0);
}

/** Adds a plane of the draw's box to the coverage within a part of the frame, and to the share. */
static void add_plane(const FlDraw *draw, const uint8_t *plane, FlRect part, int width, int opacity,
                      uint8_t *coverage, Share *share)
{
    const FlRect box = draw->area.box, both = fl_rect_and(box, part);
    uint64_t sum = 0;
    for (int y = both.y; y < both.y + both.height; y++) {
        const uint8_t *from = plane + (size_t)(y - box.y) * (size_t)box.width - box.x;
        uint8_t *restrict to = coverage + (size_t)y * (size_t)width;
        uint32_t row = 0;
        for (int x = both.x; x < both.x + both.width; x++) { // two halves make a whole pixel
            to[x] = (uint8_t)MIN(to[x] + from[x], 255);
            row += from[x];
        }
        sum += row;
    }
    share->there += sum * (uint64_t)opacity, share->all += sum;
}

/**
 * The coverage of a draw as far as it is seen within reach_px: a neck goes on below a collar. The
 * less of it is seen there the less it counts, so that no shape comes or goes abruptly.
 */
static uint8_t *near_seen(const FlCover *cover, int draw, int reach_px, GError **error)
{
    const FlRect box = cover->draws->draw[draw].area.box;
    const uint8_t *coverage = cover->draws->draw[draw].coverage, *share = cover->share[draw];
    const size_t n = fl_rect_pixels(box);
    g_autofree int16_t *seen = fl_alloc_unset(n, sizeof *seen, "a mask", error);
    g_autofree uint32_t *sums = seen ? fl_alloc_unset(n, sizeof *sums, "a mask", error) : NULL;
    uint8_t *near = sums ? fl_alloc_unset(n, 1, "a mask", error) : NULL;
    if (!near)
        return NULL;
    for (size_t p = 0; p < n; p++)
        seen[p] = share[p];
    fl_window_sums(seen, box, reach_px, sums);
    const uint32_t side = (uint32_t)(2 * reach_px + 1);
    for (size_t p = 0; p < n; p++) { // a line of pixels that crosses the window is enough
        const uint32_t part = sums[p] < 255 * side ? sums[p] / side : 255;
        near[p] = (uint8_t)MAX(share[p], coverage[p] * part / 255);
    }
    return near;
}

static int reach_of(const FlSurround *surround)
{
    return MAX(MAX(surround->width, surround->height) / REACH, 1);
}

/** Adds the draws of the region's colour to the coverage, and what holds them to `around`. */
static bool add_alike(const FlSurround *surround, const Frame *frame, const Region *region,
                      FlRect *around, Share *share, GError **error)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    for (int r = 0; r < frame->draws->n; r++) {
        const FlDraw *draw = &frame->draws->draw[r];
        if (region->edge[r] != FL_EDGE_SAME_COLOUR || fl_rect_pixels(draw->area.box) == 0)
            continue;
        if (!frame->near[r] &&
            !(frame->near[r] = near_seen(frame->cover, r, reach_of(surround), error)))
            return false;
        // an edge shows as far as translucent shapes overlap
        const int opacity = (fl_opacity(draw) * region->opacity + 127) / 255;
        add_plane(draw, frame->near[r], page, page.width, opacity, frame->coverage, share);
        *around = fl_rect_or(*around, draw->area.box);
    }
    return true;
}

/**
 * Adds what borders on the region to the coverage, within a part of the frame. Hidden or not: what
 * crosses a neighbour gives a shape at rest no other rim, and none is missed when it has passed.
 */
static void add_adjacent(const FlSurround *surround, const Frame *frame, const Region *region,
                         FlRect part, Share *share)
{
    for (int r = 0; r < frame->draws->n; r++) {
        const FlDraw *draw = &frame->draws->draw[r];
        if (region->edge[r] == FL_EDGE_ADJACENT) // a group that fades keeps its edges closed
            add_plane(draw, draw->coverage, part, surround->width,
                      MIN(fl_opacity(draw) * 255 / MAX(region->opacity, 1), 255), frame->coverage,
                      share);
    }
}

/** Stores the coverage of a part of the frame. */
static bool put(const FlSurround *surround, const Frame *frame, Kind kind, int region, FlRect part,
                GError **error)
{
    return fl_mask_store_put_part(surround->planes, plane_of(surround, kind, region), frame->number,
                                  frame->coverage, part, error);
}

/** The part of a frame on which a region's rim may depend: more than three borders around the
 * region. */
static FlRect near_region(const FlSurround *surround, FlRect box)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    return box.width > 0 ? fl_rect_grown(box, 4 * reach_of(surround), page) : box;
}

/** Stores a region, alone and with those that share its edges. */
static bool put_shared(const FlSurround *surround, const Frame *frame, Region *region,
                       GError **error)
{
    const int width = surround->width;
    Weights *weights = weights_of(surround, region->number, frame->number);
    Share alike = {0}, beside = {0};
    FlRect all = region->box;
    if (!put(surround, frame, MASK, region->number, all, error))
        return false;
    const FlRect near = near_region(surround, fl_rect_within(frame->coverage, width, region->box));
    bool done = add_alike(surround, frame, region, &all, &alike, error) &&
                (alike.all == 0 || put(surround, frame, TOGETHER, region->number, all, error));
    add_adjacent(surround, frame, region, near, &beside);
    all = fl_rect_or(all, near);
    done = done && (beside.all == 0 || put(surround, frame, CLOSED, region->number, all, error));
    *weights = (Weights){weight_of(&alike), weight_of(&beside)};
    fl_rect_clear(frame->coverage, width, all);
    return done;
}

/** Stores what is seen of a region and those of its colour, if some is not. */
static bool put_seen(const FlSurround *surround, const Frame *frame, const Region *region,
                     GError **error)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    FlRect around = {0, 0, 0, 0};
    bool hidden = false, stored = true;
    Share share = {0};
    for (int r = 0; r < frame->draws->n; r++) {
        const FlDraw *draw = &frame->draws->draw[r];
        if (draw->region != region->number && region->edge[r] != FL_EDGE_SAME_COLOUR)
            continue;
        hidden |= frame->cover->share[r] != draw->coverage;
        around = fl_rect_or(around, draw->area.box);
        add_plane(draw, frame->cover->share[r], page, page.width, 0, frame->coverage, &share);
    }
    if (hidden)
        stored = put(surround, frame, SEEN, region->number, around, error);
    fl_rect_clear(frame->coverage, page.width, around);
    return stored;
}

/** Notes which edge a region has with each draw, and how opaque it is. */
static void find_edges(const FlDrawList *draws, Region *region, const FlEdge *limits,
                       const FlNeighbours *neighbours, FlEdge *edge)
{
    region->opacity = 0;
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const bool counts = neighbours && draw->blend_mode == FL_BLEND_MODE_OVER;
        edge[r] = counts ? fl_neighbours_edge(neighbours, region->number, draw->region, limits)
                         : FL_EDGE_FREE;
        if (draw->region == region->number)
            region->opacity = MAX(region->opacity, fl_opacity(draw));
    }
    region->edge = edge;
}

static bool put_regions(const FlSurround *surround, const Frame *frame, const FlEdge *limits,
                        const int *painted_of, const FlNeighbours *neighbours, GError **error)
{
    g_autofree FlEdge *edge = g_new0(FlEdge, MAX(frame->draws->n, 1));
    for (int r = 0; r < surround->n_regions; r++) {
        Region region = {.number = r};
        if (limits[r] == FL_EDGE_NONE || (painted_of && painted_of[r] < 0))
            continue;
        find_edges(frame->draws, &region, limits, neighbours, edge);
        region.box =
            fl_draw_list_mask(frame->draws, r, surround->width, surround->height, frame->coverage);
        if (!put_shared(surround, frame, &region, error) ||
            !put_seen(surround, frame, &region, error))
            return false;
    }
    return true;
}

/** Stores the share of each pixel that shapes hide. */
static bool put_shown(const FlSurround *surround, const Frame *frame, GError **error)
{
    const FlRect page = {0, 0, surround->width, surround->height};
    for (size_t p = 0; p < fl_rect_pixels(page); p++)
        frame->coverage[p] = (uint8_t)(255 - frame->cover->free[p]);
    const bool stored = fl_mask_store_put(surround->planes, shown_plane(surround), frame->number,
                                          frame->coverage, error);
    memset(frame->coverage, 0, fl_rect_pixels(page));
    return stored;
}

/** Notes a draw as the lowest figure of pixels that have none yet; ground hides what is below. */
static void add_lowest(const FlDraw *draw, bool ground, int width, uint16_t *lowest)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++) {
        const uint8_t *coverage = draw->coverage + (size_t)y * (size_t)box.width;
        uint16_t *row = lowest + (size_t)(box.y + y) * (size_t)width + box.x;
        for (int x = 0; x < box.width; x++)
            if (coverage[x] >= 128 && (ground || row[x] == 0))
                row[x] = ground ? 0 : (uint16_t)(draw->region + 1);
    }
}

/** Stores the lowest figure of each pixel, byte by byte: of all that have paint, whichever of them
 * this run paints. */
static bool put_lowest(const FlSurround *surround, const Frame *frame, const FlEdge *limits,
                       const bool *ground, GError **error)
{
    const size_t n = (size_t)surround->width * (size_t)surround->height;
    g_autofree uint16_t *lowest = fl_alloc(n, sizeof *lowest, "regions", error);
    bool stored = lowest != NULL;
    for (int d = 0; d < frame->draws->n && stored; d++) {
        const FlDraw *draw = &frame->draws->draw[d];
        if (limits[draw->region] != FL_EDGE_NONE)
            add_lowest(draw, ground && ground[draw->region], surround->width, lowest);
    }
    for (int k = 0; k < 2 && stored; k++) {
        for (size_t p = 0; p < n; p++)
            frame->coverage[p] = (uint8_t)(lowest[p] >> (8 * k));
        stored = fl_mask_store_put(surround->planes, lowest_plane(surround, k), frame->number,
                                   frame->coverage, error);
    }
    memset(frame->coverage, 0, n);
    return stored;
}

bool fl_surround_lowest(const FlSurround *surround, int frame, FlRect part, uint16_t *lowest,
                        GError **error)
{
    const size_t n = fl_rect_pixels(part);
    g_autofree uint8_t *byte = fl_alloc_unset(n, 1, "regions", error);
    memset(lowest, 0, n * sizeof *lowest);
    for (int k = 0; k < 2 && byte; k++) {
        if (!fl_mask_store_has(surround->planes, lowest_plane(surround, k), frame))
            continue;
        if (!fl_mask_store_get(surround->planes, lowest_plane(surround, k), frame, part, byte,
                               error))
            return false;
        for (size_t p = 0; p < n; p++)
            lowest[p] = (uint16_t)(lowest[p] | byte[p] << (8 * k));
    }
    return byte;
}

bool fl_surround_put(FlSurround *surround, int frame, const FlDrawList *draws, const FlEdge *limits,
                     const int *painted_of, const bool *ground, const FlNeighbours *neighbours,
                     GError **error)
{
    const size_t n = (size_t)surround->width * (size_t)surround->height;
    g_autofree uint8_t *coverage = fl_alloc(n, 1, "masks", error);
    g_autofree uint8_t **near = g_new0(uint8_t *, MAX(draws->n, 1));
    g_auto(FlCover) cover = {0};
    if (!coverage ||
        !fl_cover_init(&cover, draws, surround->width, surround->height, (FlHiding){0}, error))
        return false;
    const Frame all = {draws, &cover, frame, near, coverage};
    const bool done = put_shown(surround, &all, error) &&
                      put_lowest(surround, &all, limits, ground, error) &&
                      put_regions(surround, &all, limits, painted_of, neighbours, error);
    for (int r = 0; r < draws->n; r++)
        free(near[r]);
    return done;
}

bool fl_surround_joins_as_in(const FlSurround *surround, int region, int a, int b)
{
    const FlMaskStore *planes = surround->planes;
    const Weights *p = weights_of(surround, region, a), *q = weights_of(surround, region, b);
    return p->together == q->together && p->closed == q->closed &&
           fl_mask_store_same(planes, plane_of(surround, TOGETHER, region), a, b) &&
           fl_mask_store_same(planes, plane_of(surround, CLOSED, region), a, b);
}

bool fl_surround_get(const FlSurround *surround, int region, int frame, FlRect part,
                     FlSurroundPlanes *around, GError **error)
{
    const FlMaskStore *planes = surround->planes;
    const Weights *weights = weights_of(surround, region, frame);
    const int plane[] = {plane_of(surround, TOGETHER, region), plane_of(surround, CLOSED, region),
                         plane_of(surround, SEEN, region), shown_plane(surround)};
    *around = (FlSurroundPlanes){.joined = (float)weights->together / 255,
                                 .bordered = (float)weights->closed / 255,
                                 .hidden = fl_mask_store_has(planes, plane[2], frame)};
    uint8_t **const read[] = {&around->together, &around->closed, &around->seen, &around->shown};
    for (size_t k = 0; k < G_N_ELEMENTS(read); k++)
        if (!(*read[k] = fl_alloc(fl_rect_pixels(part), 1, "a guide", error)) ||
            !fl_mask_store_get(planes, plane[k], frame, part, *read[k], error))
            return false;
    return true;
}

void fl_surround_planes_clear(FlSurroundPlanes *around)
{
    free(around->together);
    free(around->closed);
    free(around->seen);
    free(around->shown);
    *around = (FlSurroundPlanes){0};
}
