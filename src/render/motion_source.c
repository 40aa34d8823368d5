#include "render/motion_source.h"

#include "base/alloc.h"
#include "base/spill.h"
#include "guides/guides.h"
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

/** The leaves of two frames, paired. */
typedef struct Step {
    int references;
    int before, now;
    int64_t used;
    FlCorrespondence *motions;
} Step;

struct FlMotionSource {
    const FlDrawing *drawing;
    const FlMaskStore *masks;
    bool halved;
    GMutex lock;     // of what follows
    FlSpill *spill;  // outlines by frame, then the steps into each frame
    bool *spilled;   // by frame
    int *spilled_to; // by frame: the frame from which the step into it starts; -1: no step yet
    int64_t clock;
    Frame *frame[KEPT];
    Step *step[KEPT];
};

static void frame_unref(Frame *frame)
{
    if (!frame || --frame->references > 0)
        return;
    fl_outlines_free(frame->outlines);
    g_free(frame->fill);
    g_free(frame);
}

static void step_unref(Step *step)
{
    if (!step || --step->references > 0)
        return;
    fl_correspondence_free(step->motions);
    g_free(step);
}

FlMotionSource *fl_motion_source_new(const FlDrawing *drawing, const FlMaskStore *masks,
                                     bool halved, GError **error)
{
    const size_t n = (size_t)fl_drawing_frames(drawing);
    FlSpill *spill = fl_spill_new(2 * n, error);
    if (!spill)
        return NULL;
    FlMotionSource *source = g_new0(FlMotionSource, 1);
    source->drawing = drawing, source->masks = masks, source->spill = spill;
    source->halved = halved;
    source->spilled = g_new0(bool, n + 1);
    source->spilled_to = g_new(int, n + 1);
    for (size_t f = 0; f < n; f++)
        source->spilled_to[f] = -1;
    g_mutex_init(&source->lock);
    return source;
}

void fl_motion_source_free(FlMotionSource *source)
{
    if (!source)
        return;
    for (int k = 0; k < KEPT; k++) {
        frame_unref(source->frame[k]);
        step_unref(source->step[k]);
    }
    fl_spill_free(source->spill);
    g_free(source->spilled);
    g_free(source->spilled_to);
    g_mutex_clear(&source->lock);
    g_free(source);
}

static uint8_t *read_block(const FlMotionSource *source, size_t block, size_t *bytes,
                           GError **error)
{
    *bytes = fl_spill_bytes(source->spill, block);
    g_autofree uint8_t *data = fl_alloc(*bytes, 1, "the outlines of a frame", error);
    return data && fl_spill_get(source->spill, block, data, *bytes, error) ? g_steal_pointer(&data)
                                                                           : NULL;
}

static FlOutlines *outlines_from_spill(const FlMotionSource *source, int frame, GError **error)
{
    size_t bytes;
    g_autofree uint8_t *data = read_block(source, (size_t)frame, &bytes, error);
    FlOutlines *outlines = data ? fl_outlines_unpack(data, bytes) : NULL;
    g_assert(!data || outlines);
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

/** Pairs the leaves of two frames, and keeps that for the other regions, which come one by one. */
static FlCorrespondence *correspond(FlMotionSource *source, const Frame *before, const Frame *now,
                                    GError **error)
{
    const size_t block = (size_t)(fl_drawing_frames(source->drawing) + now->frame);
    size_t bytes;
    if (source->spilled_to[now->frame] == before->frame) {
        g_autofree uint8_t *kept = read_block(source, block, &bytes, error);
        return kept ? fl_correspondence_unpack(kept, bytes) : NULL;
    }
    const FlTwoFrames frames = {before->outlines, now->outlines, before->fill, now->fill,
                                side_of(source)};
    g_autoptr(FlCorrespondence) motions = fl_correspond(&frames);
    g_autofree uint8_t *data = fl_correspondence_pack(motions, &bytes);
    if (!fl_spill_put(source->spill, block, data, bytes, error))
        return NULL;
    source->spilled_to[now->frame] = before->frame;
    return g_steal_pointer(&motions);
}

/** The motion of the leaves from one frame to another, to be unref'd; under the lock. */
static Step *step_of(FlMotionSource *source, const Frame *before, const Frame *now, GError **error)
{
    int oldest = 0;
    for (int k = 0; k < KEPT; k++) {
        Step *s = source->step[k];
        if (s && s->before == before->frame && s->now == now->frame) {
            s->used = ++source->clock;
            s->references++;
            return s;
        }
        if (!s || (source->step[oldest] && s->used < source->step[oldest]->used))
            oldest = k;
    }
    FlCorrespondence *motions = correspond(source, before, now, error);
    if (!motions)
        return NULL;
    Step *s = g_new0(Step, 1);
    *s = (Step){2, before->frame, now->frame, ++source->clock, motions};
    step_unref(source->step[oldest]);
    source->step[oldest] = s;
    return s;
}

/** The frames and the step from which a region's motion is computed. */
typedef struct Use {
    Frame *before, *now;
    Step *step;
} Use;

static void release(FlMotionSource *source, const Use *use)
{
    g_mutex_lock(&source->lock);
    frame_unref(use->before);
    frame_unref(use->now);
    step_unref(use->step);
    g_mutex_unlock(&source->lock);
}

static bool acquire(FlMotionSource *source, int before, int now, Use *use, GError **error)
{
    g_mutex_lock(&source->lock);
    use->before = frame_of(source, before, error);
    use->now = use->before ? frame_of(source, now, error) : NULL;
    use->step = use->now ? step_of(source, use->before, use->now, error) : NULL;
    g_mutex_unlock(&source->lock);
    return use->step != NULL;
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
                            .motions = use->step->motions,
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

bool fl_motion_source_rests(FlMotionSource *source, const FlRegionStep *step)
{
    const FlOutlinePair known = step->outlines;
    if (fl_drawing_same_file(source->drawing, step->before, step->now))
        return true;
    Use use = {0};
    bool rests = known.before && known.before == known.now && !known.now->empty;
    if (rests && (rests = acquire(source, step->before, step->now, &use, NULL))) {
        g_autoptr(GArray) leaves = leaves_of(source, step->now, step->region, use.now->outlines);
        const FlMovingRegion moving = moving_of(source, step, &use, leaves);
        rests = fl_motion_rests(&moving);
    }
    release(source, &use);
    return rests;
}
