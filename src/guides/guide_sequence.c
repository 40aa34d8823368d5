#include "base/alloc.h"
#include "base/error.h"
#include "guides/displacement.h"
#include "guides/distance.h"
#include "guides/extent.h"
#include "guides/guide_planes.h"
#include "guides/plane_store.h"
#include <string.h>

/** One frame of the way back: the sum goes from frame + 1 to frame. Room: three frames. */
static bool step_back(FlGuideSequence *sequence, int frame, FlExtent *extent, uint8_t *shape,
                      int32_t *flow, int32_t *norm, GError **error)
{
    FlFrameRecord *record = &sequence->frames[frame];
    const FlFrameRecord *next = frame + 1 < sequence->source.n_frames ? record + 1 : NULL;
    const bool moves = next && next->holder[FL_GUIDE_PLANE_FLOW] >= 0;
    if (record->empty) {
        fl_extent_step(extent, &(FlRect){0}, NULL, NULL, NULL, NULL);
        return true;
    }
    if (next && !moves &&
        next->holder[FL_GUIDE_PLANE_COVERAGE_ANGLE] ==
            record->holder[FL_GUIDE_PLANE_COVERAGE_ANGLE]) {
        record->holder[FL_GUIDE_PLANE_MINUS] = next->holder[FL_GUIDE_PLANE_MINUS];
        return true;
    }
    if (!moves && !fl_extent_moved(extent)) // and so no plane is stored
        return true;
    if (!fl_guide_sequence_shape(sequence, frame, shape, error) ||
        (moves && !fl_guide_sequence_plane(sequence, frame + 1, FL_GUIDE_PLANE_FLOW, flow, error)))
        return false;
    fl_extent_step(extent, &record->box, shape, moves ? &next->box : NULL, moves ? flow : NULL,
                   norm);
    record->holder[FL_GUIDE_PLANE_MINUS] = frame;
    return fl_plane_store_put(sequence->spill, fl_guide_plane_block(frame, FL_GUIDE_PLANE_MINUS),
                              norm, fl_rect_pixels(record->box), 1, error);
}

/** The extents to come need the whole future: one pass from the last frame to the first. */
static bool make_minus_extents(FlGuideSequence *sequence, GError **error)
{
    const FlGuideSource *source = &sequence->source;
    const size_t n = (size_t)source->width * source->height;
    g_autoptr(FlExtent) extent = fl_extent_new(source->width, source->height, error);
    if (!extent)
        return false;
    g_autofree uint8_t *shape = fl_alloc(2 * n, 1, "coverages and angles", error);
    g_autofree int32_t *flow =
        shape ? fl_alloc_scratch(2 * n, sizeof *flow, "a flow", error) : NULL;
    g_autofree int32_t *norm = flow ? fl_alloc(n, sizeof *norm, "an extent", error) : NULL;
    if (!norm)
        return false;
    for (int frame = source->n_frames - 1; frame >= 0; frame--)
        if (!step_back(sequence, frame, extent, shape, flow, norm, error))
            return false;
    return true;
}

FlGuideSequence *fl_guide_sequence_new(const FlGuideSource *source, const FlGuideParams *params,
                                       GError **error)
{
    g_assert(source->width >= 1 && source->height >= 1 && source->n_frames >= 0);
    if (source->width > INT16_MAX || source->height > INT16_MAX)
        return fl_none(error, FL_ERROR_LIMIT,
                       "frames of %dx%d pixels are too large, at most %d are possible",
                       source->width, source->height, INT16_MAX);
    g_autoptr(FlGuideSequence) sequence = g_new(FlGuideSequence, 1);
    *sequence = (FlGuideSequence){.source = *source, .params = *params};
    sequence->frames = g_new0(FlFrameRecord, source->n_frames);
    sequence->spill = fl_spill_new((size_t)source->n_frames * FL_N_GUIDE_PLANES, error);
    if (!sequence->spill || !fl_guide_sequence_build(sequence, error) ||
        !make_minus_extents(sequence, error))
        return NULL;
    return g_steal_pointer(&sequence);
}

void fl_guide_sequence_free(FlGuideSequence *sequence)
{
    if (!sequence)
        return;
    fl_spill_free(sequence->spill);
    g_free(sequence->frames);
    g_free(sequence);
}

/** Copies a plane of integers of 1 / one px, cropped to `box`, into a plane of the whole width,
 * which must be all 0; rows of zeros are not written. channels: 1 or 2. */
static void place_fixed(FlRect box, const int32_t *crop, int channels, int one, int width,
                        float *plane)
{
    const float scale = 1.0f / (float)one;
    const size_t n = (size_t)box.width * channels;
    for (int y = 0; y < box.height; y++) {
        const int32_t *from = crop + y * n;
        float *to = plane + ((box.y + y) * (size_t)width + box.x) * channels;
        const bool blank = fl_is_blank((const uint8_t *)from, n * sizeof *from);
        for (size_t k = 0; k < n && !blank; k++)
            to[k] = (float)from[k] * scale;
    }
}

static bool get_plane(const FlGuideSequence *sequence, int frame, FlGuidePlane plane, float *out,
                      GError **error)
{
    const FlFrameRecord *record = &sequence->frames[frame];
    const bool flow = plane == FL_GUIDE_PLANE_FLOW;
    if (record->holder[plane] < 0)
        return true;
    g_autofree int32_t *scratch = fl_alloc_scratch((flow ? 2 : 1) * fl_rect_pixels(record->box),
                                                   sizeof *scratch, "a guide", error);
    if (!scratch || !fl_guide_sequence_plane(sequence, frame, plane, scratch, error))
        return false;
    place_fixed(record->box, scratch, flow ? 2 : 1, flow ? FL_FLOW_ONE : FL_EXTENT_ONE,
                sequence->source.width, out);
    return true;
}

/** A plane of zeros; where it has not been written to, it goes on taking no memory. */
static void clear_plane(const FlGuides *guides, void *plane, size_t bytes)
{
    if (!guides->blank && !fl_is_blank(plane, bytes))
        memset(plane, 0, bytes);
}

/** Reads the drawing's motion, which is unknown beside its shape. */
static bool get_motion(const FlGuideSequence *sequence, int frame, FlGuides *guides, GError **error)
{
    const FlFrameRecord *record = &sequence->frames[frame];
    const FlRect part = fl_guides_rect(guides);
    if (!sequence->source.motion)
        return true;
    clear_plane(guides, guides->motion, 2 * fl_rect_pixels(part) * sizeof *guides->motion);
    if (record->unknown)
        return true;
    if (record->holder[FL_GUIDE_PLANE_MOTION] >= 0) {
        g_autofree int32_t *scratch =
            fl_alloc_scratch(2 * fl_rect_pixels(record->box), sizeof *scratch, "a motion", error);
        if (!scratch ||
            !fl_guide_sequence_plane(sequence, frame, FL_GUIDE_PLANE_MOTION, scratch, error))
            return false;
        fl_rect_copy(scratch, record->box, guides->motion, part, 2 * sizeof *scratch);
    }
    guides->has_motion = !record->empty; // of the frame, whatever part this is
    fl_motion_confine(guides);
    if (guides->has_motion)
        fl_motion_turns(guides);
    return true;
}

bool fl_guide_sequence_rests(const FlGuideSequence *sequence, int frame)
{
    frame -= sequence->source.first;
    return frame > 0 && sequence->frames[frame].rests; // those before the first are not known
}

bool fl_guide_sequence_planes(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                              GError **error)
{
    const FlRect part = fl_guides_rect(guides);
    frame -= sequence->source.first;
    g_assert(frame >= 0 && frame < sequence->source.n_frames);
    const size_t n = fl_rect_pixels(part);
    memset(guides->mask, 0, n);
    memset(guides->angle, 0, n);
    clear_plane(guides, guides->flow, 2 * n * sizeof *guides->flow);
    clear_plane(guides, guides->ext_plus, n * sizeof *guides->ext_plus);
    clear_plane(guides, guides->ext_minus, n * sizeof *guides->ext_minus);
    memset(guides->bare, 255, n);
    const FlFrameRecord *record = &sequence->frames[frame];
    const size_t area = fl_rect_pixels(record->box);
    guides->has_motion = false;
    if (area > 0) {
        g_autofree uint8_t *shape = fl_alloc_unset(2 * area, 1, "coverages and angles", error);
        if (!shape || !fl_guide_sequence_shape(sequence, frame, shape, error) ||
            !get_plane(sequence, frame, FL_GUIDE_PLANE_FLOW, guides->flow, error) ||
            !get_plane(sequence, frame, FL_GUIDE_PLANE_PLUS, guides->ext_plus, error) ||
            !get_plane(sequence, frame, FL_GUIDE_PLANE_MINUS, guides->ext_minus, error))
            return false;
        fl_rect_copy(shape, record->box, guides->mask, part, 1);
        fl_rect_copy(shape + area, record->box, guides->angle, part, 1);
        if (!get_motion(sequence, frame, guides, error))
            return false;
    }
    guides->blank = false;
    return true;
}

bool fl_guide_sequence_distance(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                                GError **error)
{
    const FlRect part = fl_guides_rect(guides);
    frame -= sequence->source.first;
    const FlRect box = sequence->frames[frame].box;
    g_autofree uint8_t *shape = fl_alloc_unset(2 * fl_rect_pixels(box), 1, "coverages", error);
    memset(guides->mask, 0, fl_rect_pixels(part));
    if (!shape ||
        (fl_rect_pixels(box) > 0 && !fl_guide_sequence_shape(sequence, frame, shape, error)))
        return false;
    fl_rect_copy(shape, box, guides->mask, part, 1);
    g_clear_pointer(&shape, g_free);
    const size_t bytes = fl_rect_pixels(part) * sizeof *guides->distance;
    if (!fl_distance(guides->mask, part.width, part.height, guides->distance, error))
        return false;
    memcpy(guides->depth, guides->distance, bytes);
    return true;
}

bool fl_guide_sequence_get(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                           GError **error)
{
    return fl_guide_sequence_distance(sequence, frame, guides, error) &&
           fl_guide_sequence_planes(sequence, frame, guides, error);
}

bool fl_guides_init(FlGuides *guides, int width, int height, GError **error)
{
    const size_t n = (size_t)width * height;
    const char *what = "the guides of a frame";
    *guides = (FlGuides){.width = width, .height = height};
    if ((guides->mask = fl_alloc_unset(n, 1, what, error)) &&
        (guides->distance = fl_alloc_unset(n, sizeof *guides->distance, what, error)) &&
        (guides->depth = fl_alloc_unset(n, sizeof *guides->depth, what, error)) &&
        (guides->flow = fl_alloc_scratch(2 * n, sizeof *guides->flow, what, error)) &&
        (guides->angle = fl_alloc_scratch(n, 1, what, error)) &&
        (guides->ext_plus = fl_alloc_scratch(n, sizeof *guides->ext_plus, what, error)) &&
        (guides->ext_minus = fl_alloc_scratch(n, sizeof *guides->ext_minus, what, error)) &&
        (guides->bare = fl_alloc_scratch(n, 1, what, error)) &&
        (guides->motion = fl_alloc_scratch(2 * n, sizeof *guides->motion, what, error)) &&
        (guides->turn = fl_alloc_scratch(n, sizeof *guides->turn, what, error)))
        guides->blank = true;
    else
        fl_guides_clear(guides);
    return guides->blank;
}

void fl_guides_drop_motion(FlGuides *guides)
{
    g_clear_pointer(&guides->flow, g_free);
    g_clear_pointer(&guides->motion, g_free);
    g_clear_pointer(&guides->turn, g_free);
}

FlRect fl_guides_box(const FlGuides *guides, int least)
{
    int x0 = guides->width, y0 = guides->height, x1 = 0, y1 = 0;
    for (int y = 0; y < guides->height; y++)
        for (int x = 0; x < guides->width; x++)
            if (guides->mask[(size_t)y * (size_t)guides->width + (size_t)x] >= least) {
                x0 = MIN(x0, x), x1 = MAX(x1, x + 1);
                y0 = MIN(y0, y), y1 = MAX(y1, y + 1);
            }
    return fl_rect_between(x0, y0, x1, y1);
}

void fl_guides_clear(FlGuides *guides)
{
    g_free(guides->mask);
    g_free(guides->distance);
    g_free(guides->depth);
    g_free(guides->flow);
    g_free(guides->angle);
    g_free(guides->ext_plus);
    g_free(guides->ext_minus);
    g_free(guides->bare);
    g_free(guides->motion);
    g_free(guides->turn);
    free(guides->share);
    *guides = (FlGuides){0};
}
