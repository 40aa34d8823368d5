#include "render/motion_source.h"

#include "base/alloc.h"
#include "base/spill.h"
#include "guides/guides.h"
#include "guides/half_guides.h"
#include <string.h>

#define KEPT 6 // in memory; regions that are worked on side by side are near each other

/** A frame's outlines with their looks; counted by its users. */
typedef struct Frame {
    int references;
    int frame; // -1: free
    int64_t used;
    FlOutlines *outlines;
    FlLeafFill *fill;
} Frame;

struct FlMotionSource {
    const FlDrawing *drawing;
    const FlMaskStore *masks;
    bool halved;
    GMutex lock;    // of what follows
    FlSpill *spill; // outlines by frame
    bool *spilled;  // by frame
    int64_t clock;
    Frame *frame[KEPT];
    GHashTable *motions; // FlCorrespondence of two frames, by before * frames + now
};

static void frame_unref(Frame *frame)
{
    if (!frame || --frame->references > 0)
        return;
    fl_outlines_free(frame->outlines);
    g_free(frame->fill);
    g_free(frame);
}

FlMotionSource *fl_motion_source_new(const FlDrawing *drawing, const FlMaskStore *masks,
                                     bool halved, GError **error)
{
    const size_t n = (size_t)fl_drawing_frames(drawing);
    FlSpill *spill = fl_spill_new(n, error);
    if (!spill)
        return NULL;
    FlMotionSource *source = g_new0(FlMotionSource, 1);
    source->drawing = drawing, source->masks = masks, source->spill = spill;
    source->halved = halved;
    source->spilled = g_new0(bool, n + 1);
    source->motions = g_hash_table_new_full(g_int64_hash, g_int64_equal, g_free,
                                            (GDestroyNotify)fl_correspondence_free);
    g_mutex_init(&source->lock);
    return source;
}

void fl_motion_source_free(FlMotionSource *source)
{
    if (!source)
        return;
    for (int k = 0; k < KEPT; k++)
        frame_unref(source->frame[k]);
    fl_spill_free(source->spill);
    g_free(source->spilled);
    g_hash_table_unref(source->motions);
    g_mutex_clear(&source->lock);
    g_free(source);
}

static FlOutlines *outlines_from_spill(const FlMotionSource *source, int frame, GError **error)
{
    const size_t bytes = fl_spill_bytes(source->spill, (size_t)frame);
    g_autofree uint8_t *data = fl_alloc(bytes, 1, "the outlines of a frame", error);
    if (!data || !fl_spill_get(source->spill, (size_t)frame, data, bytes, error))
        return NULL;
    FlOutlines *outlines = fl_outlines_unpack(data, bytes);
    g_assert(outlines);
    return outlines;
}

static FlOutlines *outlines_from_file(FlMotionSource *source, int frame, GError **error)
{
    g_autoptr(FlOutlines) outlines = fl_drawing_outlines(source->drawing, frame, error);
    if (!outlines)
        return NULL;
    if (source->halved)
        fl_outlines_scale(outlines, .5);
    size_t bytes = 0;
    g_autofree uint8_t *data = fl_outlines_pack(outlines, &bytes);
    if (!fl_spill_put(source->spill, (size_t)frame, data, bytes, error))
        return NULL;
    source->spilled[frame] = true;
    return g_steal_pointer(&outlines);
}

/** A frame, to be unref'd; under the lock. */
static Frame *frame_of(FlMotionSource *source, int frame, GError **error)
{
    int oldest = 0;
    for (int k = 0; k < KEPT; k++) {
        Frame *f = source->frame[k];
        if (f && f->frame == frame) {
            f->used = ++source->clock;
            f->references++;
            return f;
        }
        if (!f || (source->frame[oldest] && f->used < source->frame[oldest]->used))
            oldest = k;
    }
    FlOutlines *outlines = source->spilled[frame] ? outlines_from_spill(source, frame, error)
                                                  : outlines_from_file(source, frame, error);
    if (!outlines)
        return NULL;
    Frame *f = g_new0(Frame, 1);
    *f = (Frame){2, frame, ++source->clock, outlines,
                 fl_drawing_leaf_fills(source->drawing, frame, outlines)};
    frame_unref(source->frame[oldest]);
    source->frame[oldest] = f;
    return f;
}

/** The larger side of the frames. */
static int side_of(const FlMotionSource *source)
{
    const int side = MAX(fl_drawing_width(source->drawing), fl_drawing_height(source->drawing));
    return source->halved ? fl_half_side(side) : side;
}

/** The motion of the leaves from one frame to another, kept for all regions; under the lock. */
static const FlCorrespondence *motions_of(FlMotionSource *source, const Frame *before,
                                          const Frame *now)
{
    const int64_t key = (int64_t)before->frame * fl_drawing_frames(source->drawing) + now->frame;
    FlCorrespondence *motions = g_hash_table_lookup(source->motions, &key);
    if (!motions) {
        motions = fl_correspond(&(FlTwoFrames){before->outlines, now->outlines, before->fill,
                                               now->fill, side_of(source)});
        g_hash_table_insert(source->motions, g_memdup2(&key, sizeof key), motions);
    }
    return motions;
}

/** The frames from which a region's motion is computed. */
typedef struct Use {
    Frame *before, *now;
    const FlCorrespondence *motions;
} Use;

static void release(FlMotionSource *source, const Use *use)
{
    g_mutex_lock(&source->lock);
    frame_unref(use->before);
    frame_unref(use->now);
    g_mutex_unlock(&source->lock);
}

static bool acquire(FlMotionSource *source, int before, int now, Use *use, GError **error)
{
    g_mutex_lock(&source->lock);
    use->before = frame_of(source, before, error);
    use->now = use->before ? frame_of(source, now, error) : NULL;
    use->motions = use->now ? motions_of(source, use->before, use->now) : NULL;
    g_mutex_unlock(&source->lock);
    return use->motions != NULL;
}

/** A mask of a region in a part of a frame. */
static bool get_mask(const FlMotionSource *source, int region, int frame, FlRect rect,
                     uint8_t *mask, GError **error)
{
    return source->halved ? fl_mask_store_get_half(source->masks, region, frame, rect, mask, error)
                          : fl_mask_store_get(source->masks, region, frame, rect, mask, error);
}

/** The leaves of a region, with their boxes as large as its motion. */
static GArray *leaves_of(const FlMotionSource *source, int frame, int region,
                         const FlOutlines *outlines)
{
    GArray *leaves = fl_drawing_region_leaves(source->drawing, frame, region, outlines);
    for (guint i = 0; i < leaves->len && source->halved; i++)
        for (int side = 0; side < 4; side++)
            g_array_index(leaves, FlRegionLeaf, i).box[side] /= 2;
    return leaves;
}

static bool is_there(const uint8_t *mask, size_t n)
{
    bool found = false;
    for (size_t p = 0; p < n && !found; p++)
        found = mask[p] >= FL_INSIDE;
    return found;
}

/** The region of a step, but for its masks. */
static FlMovingRegion moving_of(const FlMotionSource *source, const FlRegionStep *step,
                                const Use *use, GArray *leaves)
{
    return (FlMovingRegion){.rect = source->halved ? fl_rect_halved(step->rect) : step->rect,
                            .side = side_of(source),
                            .outlines = step->outlines,
                            .fluid = step->fluid,
                            .wetness = step->wetness,
                            .before = use->before->outlines,
                            .now = use->now->outlines,
                            .motions = use->motions,
                            .leaves = leaves};
}

bool fl_motion_source_get(FlMotionSource *source, const FlRegionStep *step, float *motion,
                          FlMotionShares *shares, GError **error)
{
    const int region = step->region, before = step->before, now = step->now;
    const FlRect rect = source->halved ? fl_rect_halved(step->rect) : step->rect;
    const size_t n = fl_rect_pixels(rect);
    if (shares)
        *shares = (FlMotionShares){0, 0};
    memset(motion, 0, 2 * n * sizeof *motion);
    if (fl_drawing_same_file(source->drawing, before, now))
        return true;
    g_autofree uint8_t *mask_before = fl_alloc(n, 1, "a mask", error);
    g_autofree uint8_t *mask_now = mask_before ? fl_alloc(n, 1, "a mask", error) : NULL;
    if (!mask_now || !get_mask(source, region, before, step->rect, mask_before, error) ||
        !get_mask(source, region, now, step->rect, mask_now, error))
        return false;
    if (!is_there(mask_before, n) || !is_there(mask_now, n))
        return true;
    Use use = {0};
    bool good = acquire(source, before, now, &use, error);
    if (good) {
        g_autoptr(GArray) leaves = leaves_of(source, now, region, use.now->outlines);
        FlMovingRegion moving = moving_of(source, step, &use, leaves);
        moving.mask_before = mask_before, moving.mask_now = mask_now;
        good = fl_motion_of_region(&moving, motion, shares, error);
    }
    release(source, &use);
    return good;
}

bool fl_motion_source_whole(void *source, int region, int before, int now, FlRect rect,
                            float *motion, GError **error)
{
    const FlRegionStep step = {region, before, now, rect, {NULL, NULL}};
    g_autofree float *half =
        fl_alloc_unset(2 * fl_rect_pixels(fl_rect_halved(rect)), sizeof *half, "a motion", error);
    if (!half || !fl_motion_source_get(source, &step, half, NULL, error))
        return false;
    fl_flow_double(half, rect.width, rect.height, motion);
    return true;
}
