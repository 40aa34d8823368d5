/*
 * The forward pass through a sequence. Each stage asks the one before for the frames it needs, in
 * order, and keeps a window of them:
 *
 *   outline_of   mask, box, distance
 *   distance_of  the distance smoothed along time and in space, if asked for [P21 §4.1]
 *   motion_of    the flow of one interval
 *   finish_frame the flow smoothed along time [F21 App. A], direction, extent; into the spill
 */
#include "base/alloc.h"
#include "base/error.h"
#include "guides/blur.h"
#include "guides/direction.h"
#include "guides/displacement.h"
#include "guides/extent.h"
#include "guides/flow.h"
#include "guides/gauss.h"
#include "guides/guide_planes.h"
#include "guides/plane_store.h"
#include <math.h>
#include <string.h>

/** The flow of one frame before smoothing. */
typedef struct Motion {
    int frame;   // -1: the slot is free
    float *flow; // interleaved, of the outline's box; NULL: no motion
} Motion;

typedef struct OutlineSlot {
    int frame; // -1: the slot is free
    FlOutline *outline;
} OutlineSlot;

typedef struct Smoothed {
    int frame;
    float *distance;
} Smoothed;

typedef struct Builder {
    FlGuideSequence *sequence;
    bool smooths;                     // distances, before flow is made from them
    int flow_radius, dist_radius;     // frames on either side
    float *flow_weight, *dist_weight; // radius + 1
    int n_slots;
    OutlineSlot *outlines; // frame f is in slot f % n_slots, as below
    Motion *motions;
    Smoothed smoothed[3];
    uint8_t *mask; // scratch: a frame
    FlExtent *extent;
    bool stirs;          // flow or motion of the frame that is being finished
    bool previous_moves; // of the frame that was finished last
} Builder;

static void builder_clear(Builder *b)
{
    for (int s = 0; s < b->n_slots; s++) {
        fl_outline_unref(b->outlines[s].outline);
        g_free(b->motions[s].flow);
    }
    for (int s = 0; s < 3; s++)
        g_free(b->smoothed[s].distance);
    g_free(b->outlines);
    g_free(b->motions);
    g_free(b->flow_weight);
    g_free(b->dist_weight);
    g_free(b->mask);
    fl_extent_free(b->extent);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Builder, builder_clear)

static float *temporal_weights(float sigma_frames, int *radius)
{
    *radius = sigma_frames > 0.0f ? (int)(3.0f * sigma_frames) : 0;
    float *weight = g_new(float, *radius + 1);
    weight[0] = 1.0f;
    if (*radius > 0)
        fl_gauss_weights(weight, *radius, sigma_frames);
    return weight;
}

static bool builder_init(Builder *b, FlGuideSequence *sequence, GError **error)
{
    const FlGuideSource *source = &sequence->source;
    const size_t n = (size_t)source->width * source->height;
    *b = (Builder){.sequence = sequence};
    b->flow_weight = temporal_weights(sequence->params.flow_sigma_frames, &b->flow_radius);
    b->dist_weight = temporal_weights(sequence->params.dist_sigma_frames, &b->dist_radius);
    b->smooths = b->dist_radius > 0 || sequence->params.dist_sigma_px > 0.0f;
    const int n_slots = 2 * (b->flow_radius + b->dist_radius) + 6;
    b->outlines = g_new0(OutlineSlot, n_slots);
    b->motions = g_new0(Motion, n_slots);
    b->n_slots = n_slots;
    for (int s = 0; s < n_slots; s++)
        b->outlines[s].frame = b->motions[s].frame = -1;
    for (int s = 0; s < 3; s++)
        b->smoothed[s].frame = -1;
    if (!(b->mask = fl_alloc(n, 1, "a mask", error)))
        return false;
    b->extent = fl_extent_new(source->width, source->height, error);
    return b->extent;
}

/** *outline stays the builder's; NULL beyond either end. */
static bool outline_of(Builder *b, int frame, FlOutline **outline, GError **error)
{
    const FlGuideSource *source = &b->sequence->source;
    *outline = NULL;
    if (frame < 0 || frame >= source->n_frames)
        return true;
    OutlineSlot *slot = &b->outlines[frame % b->n_slots];
    if (slot->frame != frame) {
        const OutlineSlot *last = &b->outlines[(frame + b->n_slots - 1) % b->n_slots];
        if (!source->mask(source->data, source->first + frame, b->mask, error))
            return false;
        FlOutline *fresh = last->outline && fl_outline_equal(last->outline, b->mask)
                               ? fl_outline_ref(last->outline)
                               : fl_outline_new(b->mask, source->width, source->height, error);
        if (!fresh)
            return false;
        fl_outline_unref(slot->outline);
        *slot = (OutlineSlot){frame, fresh};
    }
    *outline = slot->outline;
    return true;
}

/** Weighted mean of the distances around a frame, frames without a shape left out. */
static bool mean_distance(Builder *b, int frame, float *distance, GError **error)
{
    const size_t n = (size_t)b->sequence->source.width * b->sequence->source.height;
    float norm = 0.0f;
    memset(distance, 0, n * sizeof *distance);
    for (int k = -b->dist_radius; k <= b->dist_radius; k++) {
        FlOutline *outline;
        if (!outline_of(b, frame + k, &outline, error))
            return false;
        if (!outline || outline->empty)
            continue;
        const float weight = b->dist_weight[ABS(k)];
        norm += weight;
        for (size_t p = 0; p < n; p++)
            distance[p] += weight * outline->distance[p];
    }
    for (size_t p = 0; p < n; p++)
        distance[p] /= norm;
    return true;
}

static bool smooth_distance(Builder *b, int frame, float *distance, GError **error)
{
    const FlGuideSource *source = &b->sequence->source;
    const float sigma = b->sequence->params.dist_sigma_px;
    return mean_distance(b, frame, distance, error) &&
           (sigma <= 0.0f || fl_blur(distance, source->width, source->height, sigma, error));
}

/** The frame, with the distance field that determines its motion. */
static bool distance_of(Builder *b, int frame, FlFlowFrame *out, GError **error)
{
    FlOutline *outline;
    if (!outline_of(b, frame, &outline, error))
        return false;
    *out = (FlFlowFrame){outline, outline ? outline->distance : NULL};
    if (!outline || outline->empty || !b->smooths)
        return true;
    Smoothed *slot = &b->smoothed[frame % 3];
    const size_t n = (size_t)outline->frame_width * outline->frame_height;
    if (slot->frame != frame) {
        if (!slot->distance &&
            !(slot->distance = fl_alloc(n, sizeof(float), "a smoothed distance", error)))
            return false;
        slot->frame = -1;
        if (!smooth_distance(b, frame, slot->distance, error))
            return false;
        slot->frame = frame;
    }
    out->distance = slot->distance;
    return true;
}

static bool construct_motion(Builder *b, int frame, float **flow, GError **error)
{
    const FlGuideSource *source = &b->sequence->source;
    const float limit = b->sequence->params.flow_limit * (float)MAX(source->width, source->height);
    FlFlowFrame now, before, after;
    if (!distance_of(b, frame - 1, &before, error) || !distance_of(b, frame, &now, error) ||
        !distance_of(b, frame + 1, &after, error))
        return false;
    const FlOutline *other = before.outline ? before.outline : after.outline; // as of a first frame
    if (now.outline->empty || (!b->smooths && now.outline == other))
        return true;
    g_autofree float *fresh =
        fl_alloc_unset(2 * fl_rect_pixels(now.outline->box), sizeof *fresh, "a flow", error);
    bool moves;
    if (!fresh || !fl_flow_construct(&now, &before, &after, limit, fresh, &moves, error))
        return false;
    *flow = moves ? g_steal_pointer(&fresh) : NULL;
    return true;
}

static bool motion_of(Builder *b, int frame, const Motion **motion, GError **error)
{
    Motion *slot = &b->motions[frame % b->n_slots];
    if (slot->frame != frame) {
        g_clear_pointer(&slot->flow, g_free);
        if (!construct_motion(b, frame, &slot->flow, error))
            return false;
        slot->frame = frame;
    }
    *motion = slot;
    return true;
}

/** Adds weight times a frame's motion to the flow of another, where both masks have the pixel. */
static void add_motion(const FlOutline *to, const FlOutline *from, const float *motion,
                       float weight, float *flow, float *norm)
{
    const FlRect *a = &to->box, *b = &from->box, both = fl_rect_and(*a, *b);
    for (int y = both.y; y < both.y + both.height; y++) {
        size_t p = (y - a->y) * (size_t)a->width + both.x - a->x;
        size_t q = (y - b->y) * (size_t)b->width + both.x - b->x;
        for (int x = 0; x < both.width; x++, p++, q++) {
            if (!(to->coverage[p] & from->coverage[q] & FL_INSIDE))
                continue;
            norm[p] += weight;
            if (motion) {
                flow[2 * p] += weight * motion[2 * q];
                flow[2 * p + 1] += weight * motion[2 * q + 1];
            }
        }
    }
}

/** Frees the motion that the window of the next frame no longer has. */
static void drop_motion(Builder *b, int frame)
{
    const int first = frame - b->flow_radius;
    if (first < 0)
        return;
    Motion *slot = &b->motions[first % b->n_slots];
    g_clear_pointer(&slot->flow, g_free);
    slot->frame = -1;
}

/** *flow: NULL without motion in the whole window, else of outline's box, to be freed. */
static bool smooth_motion(Builder *b, int frame, const FlOutline *outline, float **flow,
                          GError **error)
{
    const int first = MAX(frame - b->flow_radius, 0);
    const int last = MIN(frame + b->flow_radius, b->sequence->source.n_frames - 1);
    bool moves = false;
    for (int k = first; k <= last; k++) { // in order: windows move forward only
        const Motion *motion;
        if (!motion_of(b, k, &motion, error))
            return false;
        moves |= motion->flow != NULL;
    }
    if (!moves)
        return true;
    const size_t n = fl_rect_pixels(outline->box);
    g_autofree float *sum = fl_alloc(2 * n, sizeof *sum, "a smoothed flow", error);
    g_autofree float *norm = sum ? fl_alloc(n, sizeof *norm, "a smoothed flow", error) : NULL;
    if (!norm)
        return false;
    for (int k = first; k <= last; k++) {
        const FlOutline *from = b->outlines[k % b->n_slots].outline;
        add_motion(outline, from, b->motions[k % b->n_slots].flow, b->flow_weight[ABS(k - frame)],
                   sum, norm);
    }
    for (size_t p = 0; p < n; p++)
        if (norm[p] > 0.0f)
            sum[2 * p] /= norm[p], sum[2 * p + 1] /= norm[p];
    *flow = g_steal_pointer(&sum);
    return true;
}

/** Room for the flow or the motion of a frame, to be freed. */
static float *room_for_motion(const FlGuideSource *source, GError **error)
{
    return fl_alloc_scratch(2 * (size_t)source->width * source->height, sizeof(float),
                            "a given motion", error);
}

/** The flow that the source gives, cropped to the shape. */
static bool given_flow(Builder *b, int frame, const FlOutline *outline, float **flow,
                       GError **error)
{
    const FlGuideSource *source = &b->sequence->source;
    const FlRect *box = &outline->box;
    g_autofree float *given = room_for_motion(source, error);
    if (!given || !source->flow(source->data, source->first + frame, given, error))
        return false;
    float *out = *flow = fl_alloc(2 * fl_rect_pixels(*box), sizeof *out, "a given flow", error);
    if (!out)
        return false;
    for (int y = 0; y < box->height; y++)
        for (int x = 0; x < box->width; x++, out += 2) {
            const float *in = given + 2 * ((box->y + y) * (size_t)source->width + box->x + x);
            if (!isfinite(in[0]) || !isfinite(in[1]))
                return fl_fail(error, FL_ERROR_INPUT,
                               "the flow of frame %d is not a number at column %d, row %d", frame,
                               box->x + x, box->y + y);
            if (fl_outline_contains(outline, box->x + x, box->y + y))
                out[0] = in[0], out[1] = in[1];
        }
    return true;
}

/** Stores coverage and direction; computes the outline's normals on demand. */
static bool put_shape(Builder *b, int frame, FlOutline *outline, const float *flow, GError **error)
{
    const size_t n = fl_rect_pixels(outline->box);
    if (!outline->empty && !outline->normal && !fl_outline_normals(outline, error))
        return false;
    g_autofree uint8_t *shape = fl_alloc(2 * n, 1, "coverages and angles", error);
    if (!shape)
        return false;
    memcpy(shape, outline->coverage, n);
    if (!outline->empty)
        fl_direction(outline->coverage, flow, outline->normal, n, b->sequence->params.still_px,
                     shape + n);
    b->sequence->frames[frame].holder[FL_GUIDE_PLANE_COVERAGE_ANGLE] = frame;
    return fl_spill_put(b->sequence->spill,
                        fl_guide_plane_block(frame, FL_GUIDE_PLANE_COVERAGE_ANGLE), shape, 2 * n,
                        error);
}

/** True if a flow of integers is faster than still anywhere in the shape. */
static bool any_flows(const int32_t *flow, const FlOutline *outline, float still_px)
{
    const float scale = 1.0f / FL_FLOW_ONE, still = still_px * still_px;
    bool flows = false;
    for (size_t p = 0; p < fl_rect_pixels(outline->box) && !flows; p++) {
        const float u = (float)flow[2 * p] * scale, v = (float)flow[2 * p + 1] * scale;
        flows = outline->coverage[p] >= FL_INSIDE && u * u + v * v > still;
    }
    return flows;
}

/** Stores the flow, of integers. */
static bool put_flow(Builder *b, int frame, const FlOutline *outline, const int32_t *flow,
                     GError **error)
{
    b->stirs |= any_flows(flow, outline, b->sequence->params.still_px);
    b->sequence->frames[frame].holder[FL_GUIDE_PLANE_FLOW] = frame;
    return fl_plane_store_put(b->sequence->spill, fl_guide_plane_block(frame, FL_GUIDE_PLANE_FLOW),
                              flow, 2 * fl_rect_pixels(outline->box), 2, error);
}

/** Stores the extent up to this frame, unless that is 0 all over; flow may be NULL. */
static bool put_extent(Builder *b, int frame, const FlOutline *outline, const int32_t *flow,
                       GError **error)
{
    FlFrameRecord *record = &b->sequence->frames[frame];
    const size_t n = fl_rect_pixels(outline->box);
    // a frame without predecessor borrows its flow from the next interval, which is not counted
    const bool counts = flow && frame > 0 && !record[-1].empty;
    if (!counts && !fl_extent_moved(b->extent))
        return true;
    g_autofree int32_t *norm = fl_alloc_unset(n, sizeof *norm, "an extent", error);
    if (!norm)
        return false;
    fl_extent_step(b->extent, &record->box, outline->coverage, &record->box, counts ? flow : NULL,
                   norm);
    record->holder[FL_GUIDE_PLANE_PLUS] = frame;
    return fl_plane_store_put(b->sequence->spill, fl_guide_plane_block(frame, FL_GUIDE_PLANE_PLUS),
                              norm, n, 1, error);
}

/** Stores the flow and the extent; flow may be NULL. */
static bool put_motion(Builder *b, int frame, const FlOutline *outline, const float *flow,
                       GError **error)
{
    const size_t n = 2 * fl_rect_pixels(outline->box);
    if (!flow)
        return put_extent(b, frame, outline, NULL, error);
    g_autofree int32_t *fixed = fl_alloc_unset(n, sizeof *fixed, "a flow", error);
    if (!fixed)
        return false;
    for (size_t k = 0; k < n; k++)
        fixed[k] = fl_flow_to_fixed(flow[k]);
    return put_extent(b, frame, outline, fixed, error) && put_flow(b, frame, outline, fixed, error);
}

/** True if a motion of the outline's box is known anywhere in the shape. */
static bool any_known(const int32_t *motion, const FlOutline *outline)
{
    bool known = false;
    for (size_t p = 0; p < fl_rect_pixels(outline->box) && !known; p++)
        known = outline->coverage[p] >= FL_INSIDE && motion[2 * p] != FL_MOTION_UNKNOWN;
    return known;
}

/** True if anything in the shape is known to move. */
static bool any_moves(const int32_t *motion, const FlOutline *outline)
{
    bool moves = false;
    for (size_t p = 0; p < fl_rect_pixels(outline->box) && !moves; p++)
        moves = outline->coverage[p] >= FL_INSIDE && motion[2 * p] != FL_MOTION_UNKNOWN &&
                (motion[2 * p] | motion[2 * p + 1]) != 0;
    return moves;
}

/** Stores the drawing's motion into this frame, if there is any: *motion, to be freed, else NULL.
 */
static bool put_drawing_motion(Builder *b, int frame, FlOutline *outline, int32_t **motion,
                               GError **error)
{
    const FlGuideSource *source = &b->sequence->source;
    const size_t n = 2 * fl_rect_pixels(outline->box);
    FlOutlinePair outlines = {.now = outline};
    if (!source->motion || outline->empty)
        return true;
    if (!outline_of(b, frame - 1, &outlines.before, error))
        return false;
    g_autofree float *given = room_for_motion(source, error);
    if (!given || !source->motion(source->data, source->first + frame, &outlines, given, error))
        return false;
    const size_t values = 2 * (size_t)source->width * (size_t)source->height;
    if (fl_is_blank((const uint8_t *)given, values * sizeof *given))
        return true;
    g_autofree int32_t *fixed = fl_alloc_scratch(n, sizeof *fixed, "a drawing's motion", error);
    if (!fixed)
        return false;
    fl_motion_to_fixed(given, outline, fixed);
    g_clear_pointer(&given, g_free); // it is large, and so is what storing takes
    if (fl_is_blank((const uint8_t *)fixed, n * sizeof *fixed))
        return true;
    if (!any_known(fixed, outline)) {
        b->sequence->frames[frame].unknown = true;
        return true;
    }
    b->stirs |= any_moves(fixed, outline);
    b->sequence->frames[frame].holder[FL_GUIDE_PLANE_MOTION] = frame;
    *motion = g_steal_pointer(&fixed);
    return fl_plane_store_put(b->sequence->spill,
                              fl_guide_plane_block(frame, FL_GUIDE_PLANE_MOTION), *motion, n, 2,
                              error);
}

/** Directions alone need normals, which are large: those of an outline may go, unless the next
 * frame has it as well. */
static void drop_normals(const Builder *b, int frame, FlOutline *outline)
{
    if (b->outlines[(frame + 1) % b->n_slots].outline != outline)
        g_clear_pointer(&outline->normal, g_free);
}

static bool finish_frame(Builder *b, int frame, GError **error)
{
    FlFrameRecord *record = &b->sequence->frames[frame];
    FlOutline *outline;
    g_autofree float *flow = NULL;
    if (!outline_of(b, frame, &outline, error))
        return false;
    // NOLINTNEXTLINE(clang-analyzer-core.NullDereference): set where no error is
    *record = (FlFrameRecord){outline->box, outline->empty, .holder = {-1, -1, -1, -1, -1}};
    b->stirs = false;
    if (outline->box.width == 0) {
        fl_extent_step(b->extent, &record->box, NULL, NULL, NULL, NULL);
        return true;
    }
    if (!outline->empty &&
        !(b->sequence->source.flow ? given_flow(b, frame, outline, &flow, error)
                                   : smooth_motion(b, frame, outline, &flow, error)))
        return false;
    drop_motion(b, frame);
    const OutlineSlot *last = &b->outlines[(frame + b->n_slots - 1) % b->n_slots];
    const bool still = frame > 0 && last->outline == outline && !flow && !b->previous_moves;
    b->previous_moves = flow != NULL;
    if (still) { // equals the frame before
        memcpy(record->holder, record[-1].holder, sizeof record->holder);
        record->holder[FL_GUIDE_PLANE_MOTION] = -1;
    } else if (!put_shape(b, frame, outline, flow, error) ||
               !put_motion(b, frame, outline, flow, error)) {
        return false;
    }
    drop_normals(b, frame, outline);
    g_clear_pointer(&flow, g_free); // the drawing's motion takes much itself
    g_autofree int32_t *motion = NULL;
    if (!put_drawing_motion(b, frame, outline, &motion, error))
        return false;
    record->rests = frame > 0 && !outline->empty && last->outline == outline && !b->stirs;
    return true;
}

bool fl_guide_sequence_build(FlGuideSequence *sequence, GError **error)
{
    g_auto(Builder) builder = {0};
    bool done = builder_init(&builder, sequence, error);
    for (int frame = 0; frame < sequence->source.n_frames && done; frame++)
        done = finish_frame(&builder, frame, error);
    return done;
}
