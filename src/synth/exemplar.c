#include "synth/exemplar.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/schedule.h"
#include "base/spill.h"
#include "guides/distance.h"
#include "style/adapt.h"
#include "synth/spline.h"
#include <string.h>

#define MIN_SEGMENT 25 // pixels; with fewer on a level, border and interior are one segment

int fl_levels_of(int width, int height)
{
    int levels = 0;
    for (int side = MIN(width, height) / FL_PATCH; side > 1; side /= 2)
        levels++;
    return CLAMP(levels, 1, FL_MAX_LEVELS);
}

bool fl_shape_guide(const FlGuides *guides, const FlParams *params, float border_px, float *shape,
                    GError **error)
{
    if (params->shape_ramp)
        fl_shape_ramp(guides->distance, guides->width, guides->height, border_px, shape);
    else if (params->shape_edge > 0)
        fl_shape_edge(guides->depth, guides->width, guides->height, border_px,
                      params->shape_edge * border_px, shape);
    else
        return fl_shape_blur(guides->mask, guides->width, guides->height, border_px, shape, error);
    return true;
}

struct FlExemplarFrames {
    FlParams params;
    FlGuideSequence *sequence;
    FlSpill *rgb;         // a block for each frame; NULL: all are in the window
    int earliest, latest; // frames with paint
};

static void frames_free(FlExemplarFrames *frames)
{
    if (!frames)
        return;
    fl_guide_sequence_free(frames->sequence);
    fl_spill_free(frames->rgb);
    g_free(frames);
}
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlExemplarFrames, frames_free)

static void keep_guides(FlExemplar *exemplar, const FlGuides *guides, int t)
{
    const size_t pixels = (size_t)guides->width * (size_t)guides->height;
    const size_t at = (size_t)t * pixels;
    memcpy(exemplar->distance + at, guides->depth, pixels * sizeof(float));
    memcpy(exemplar->ext_plus + at, guides->ext_plus, pixels * sizeof(float));
    memcpy(exemplar->ext_minus + at, guides->ext_minus, pixels * sizeof(float));
}

/* The guides of a frame. Those of all frames were got once before: if there is room for all, their
 * distances are where the exemplar's depths will be. */
static bool get_guides(const FlExemplar *exemplar, const FlExemplarFrames *frames, int t,
                       FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)guides->width * (size_t)guides->height;
    if (frames->rgb)
        return fl_guide_sequence_get(frames->sequence, t, guides, error);
    memcpy(guides->distance, exemplar->distance + (size_t)t * pixels,
           pixels * sizeof *guides->distance);
    memcpy(guides->depth, guides->distance, pixels * sizeof *guides->depth);
    return fl_guide_sequence_planes(frames->sequence, t, guides, error);
}

/* Level 0 of one frame: its guides, and its colours. */
static bool fill_frame(FlExemplar *exemplar, const FlExemplarFrames *frames, const uint8_t *rgb,
                       int t, FlPyramid *pyramid, GError **error)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t pixels = (size_t)level->width * (size_t)level->height;
    g_auto(FlGuides) guides = {0};
    float *shape = pyramid->plane[FL_PLANE_R]; // scratch: the colours come later
    if (!fl_guides_init(&guides, level->width, level->height, error) ||
        !get_guides(exemplar, frames, t, &guides, error))
        return false;
    for (size_t p = 0; p < pixels; p++)
        guides.depth[p] -= exemplar->margin_px;
    if (!fl_shape_guide(&guides, &frames->params, exemplar->border_px, shape, error))
        return false;
    keep_guides(exemplar, &guides, t);
    fl_pyramid_fill(pyramid, &guides, shape, (FlRect){0, 0, level->width, level->height});
    for (size_t c = 0; c < 3; c++)
        for (size_t p = 0; p < pixels; p++)
            pyramid->plane[FL_PLANE_R + c][p] = rgb[3 * p + c] / 255.0f;
    return true;
}

/* Builds every level of one frame from its level 0. */
static bool pack_pyramid(FlExemplar *exemplar, FlPyramid *full, int t, GError **error)
{
    g_autofree float *planes =
        fl_alloc(3 * (size_t)full->width * full->height, sizeof *planes, "an exemplar", error);
    if (!planes)
        return false;
    const uint8_t *paper = exemplar->paper;
    const FlPacking packing = {exemplar->separate,
                               exemplar->border_px,
                               exemplar->bare,
                               exemplar->ext_scale,
                               {paper[0], paper[1], paper[2]}};
    fl_exemplar_level_pack(&exemplar->level[0], full, &packing, t, planes);
    g_auto(FlPyramid) fine = {0};
    for (int l = 1; l < exemplar->n_levels; l++) {
        FlExemplarLevel *level = &exemplar->level[l];
        FlPyramid coarse;
        if (!fl_pyramid_init(&coarse, level->width, level->height, FL_PLANES, error))
            return false;
        fl_pyramid_halve(l == 1 ? full : &fine, &coarse);
        fl_pyramid_clear(&fine);
        fine = coarse;
        fl_exemplar_level_pack(level, &fine, &packing, t, planes);
    }
    return true;
}

/* Frees the frames t to end - 1, but for their masks; all at once, since a page that two frames
 * share is freed with both only. */
static void release_frames(FlExemplar *exemplar, int t, int end)
{
    const size_t pixels = (size_t)exemplar->level[0].width * (size_t)exemplar->level[0].height;
    const size_t from = (size_t)t, n = (size_t)(end - t);
    float *const planes[] = {exemplar->distance, exemplar->ext_plus, exemplar->ext_minus};
    for (int l = 0; l < exemplar->n_levels; l++) {
        const FlExemplarLevel *level = &exemplar->level[l];
        const size_t frame = level->frame_pixels;
        fl_release(level->pixels + from * frame, n * frame * sizeof(FlTexel));
        fl_release(level->colour + from * frame, n * frame * sizeof(FlSplinePixel));
    }
    for (size_t k = 0; k < G_N_ELEMENTS(planes); k++)
        fl_release(planes[k] + from * pixels, n * pixels * sizeof(float));
}

#define BARE 0.3              // of the interior's mean difference from the paper
#define MARGIN 0.0625         // likewise: less is no paint yet
enum { DEEPEST_MARGIN = 64 }; // px

/* The colour difference of paint and paper, summed over channels, by the paint's depth in whole px
 * and below the border. */
typedef struct Contrast {
    uint64_t sum, n;
    uint64_t sum_at[DEEPEST_MARGIN], n_at[DEEPEST_MARGIN];
} Contrast;

static void add_contrast(Contrast *contrast, const FlStyle *style, int t, const float *distance,
                         float border_px)
{
    const size_t pixels = (size_t)style->width * (size_t)style->height;
    const uint8_t *mask = style->mask + (size_t)t * pixels;
    const uint8_t *rgb = style->rgb + 3 * (size_t)t * pixels;
    for (size_t p = 0; p < pixels; p++) {
        const float depth = distance[p];
        uint64_t apart = 0;
        if (mask[p] < FL_INSIDE || depth < 0)
            continue;
        for (size_t c = 0; c < 3; c++)
            apart += (uint64_t)abs(rgb[3 * p + c] - style->paper[c]);
        if (depth >= border_px)
            contrast->sum += apart, contrast->n++;
        if (depth < DEEPEST_MARGIN)
            contrast->sum_at[(int)depth] += apart, contrast->n_at[(int)depth]++;
    }
}

/* The depth, of a border at most, at which there is paint at all. */
static float margin_of(const Contrast *contrast, float border_px)
{
    const double least = MARGIN * (double)contrast->sum / (double)contrast->n;
    double before = 0;
    for (int d = 0; d < DEEPEST_MARGIN && (float)d < border_px && contrast->n_at[d] > 0; d++) {
        const double mean = (double)contrast->sum_at[d] / (double)contrast->n_at[d];
        if (mean >= least) // means are those of the middle of a pixel
            return d == 0 ? 0.0f : (float)(d - 0.5 + (least - before) / (mean - before));
        before = mean;
    }
    return 0.0f;
}

#define PACKERS 4 // threads at most: each takes the planes of a frame

/* Statistics of the guides of all frames. */
typedef struct Measured {
    float most; // extent
    Contrast contrast;
} Measured;

static void merge_contrast(Contrast *sum, const Contrast *contrast)
{
    sum->sum += contrast->sum, sum->n += contrast->n;
    for (int d = 0; d < DEEPEST_MARGIN; d++)
        sum->sum_at[d] += contrast->sum_at[d], sum->n_at[d] += contrast->n_at[d];
}

/* Copies the mask of frame t, and adds what its guides say. */
static bool measure_frame(FlExemplar *exemplar, const FlStyle *style,
                          const FlExemplarFrames *frames, int t, FlGuides *guides,
                          Measured *measured, GError **error)
{
    const size_t pixels = (size_t)guides->width * (size_t)guides->height;
    if (!fl_guide_sequence_get(frames->sequence, t, guides, error))
        return false;
    memcpy(exemplar->mask + (size_t)t * pixels, guides->mask, pixels);
    if (!frames->rgb)
        memcpy(exemplar->distance + (size_t)t * pixels, guides->distance,
               pixels * sizeof *guides->distance);
    for (size_t p = 0; p < pixels; p++)
        measured->most = MAX(measured->most, MAX(guides->ext_plus[p], guides->ext_minus[p]));
    add_contrast(&measured->contrast, style, t, guides->distance, exemplar->border_px);
    return true;
}

/* Copies the masks and finds the extents of all frames, which give the scale, and what is bare,
 * but for guides as the papers have them. */
static bool measure_extents(FlExemplar *exemplar, const FlStyle *style, FlExemplarFrames *frames,
                            GError **error)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    Measured all = {0};
    GError *first = NULL;
#pragma omp parallel num_threads(fl_schedule_threads_up_to(PACKERS))
    {
        GError *failure = NULL;
        Measured own = {0};
        g_auto(FlGuides) guides = {0};
        const bool ready = fl_guides_init(&guides, level->width, level->height, &failure);
#pragma omp for schedule(dynamic, 1)
        for (int t = 0; t < level->n_frames; t++)
            if (ready && !failure)
                (void)measure_frame(exemplar, style, frames, t, &guides, &own, &failure);
#pragma omp critical
        {
            all.most = MAX(all.most, own.most);
            merge_contrast(&all.contrast, &own.contrast);
        }
        fl_parallel_error_keep(&first, failure);
    }
    exemplar->ext_scale = all.most > 0 ? 1 / all.most : 1;
    if (fl_knows_depth(&frames->params) && all.contrast.n > 0) {
        exemplar->bare = (float)(BARE * (double)all.contrast.sum / (double)all.contrast.n / 255);
        exemplar->margin_px = margin_of(&all.contrast, exemplar->border_px);
    }
    return fl_parallel_error_propagate(error, first);
}

/* The margin of a style, without any other guides. */
static bool measure_margin(const FlStyle *style, float border_px, float *margin_px, GError **error)
{
    const size_t pixels = (size_t)style->width * (size_t)style->height;
    Contrast all = {0};
    GError *first = NULL;
#pragma omp parallel num_threads(fl_schedule_threads_up_to(PACKERS))
    {
        GError *failure = NULL;
        Contrast own = {0};
        g_autofree float *distance =
            fl_alloc_unset(pixels, sizeof *distance, "an exemplar", &failure);
#pragma omp for schedule(dynamic, 1)
        for (int t = 0; t < style->n_frames; t++)
            if (!failure && fl_distance(style->mask + (size_t)t * pixels, style->width,
                                        style->height, distance, &failure))
                add_contrast(&own, style, t, distance, border_px);
#pragma omp critical
        merge_contrast(&all, &own);
        fl_parallel_error_keep(&first, failure);
    }
    *margin_px = all.n > 0 ? margin_of(&all, border_px) : 0;
    return fl_parallel_error_propagate(error, first);
}

typedef size_t SegmentCounts[FL_MAX_LEVELS][FL_SEGMENTS]; // pixels of each level and segment

/* Packs frame t, and keeps it if it is one of the window. own: its counts. */
static bool pack_one(FlExemplar *exemplar, const FlStyle *style, const FlExemplarFrames *frames,
                     int t, FlPyramid *full, SegmentCounts own, GError **error)
{
    const size_t bytes = 3 * (size_t)style->width * (size_t)style->height;
    const uint8_t *rgb = style->rgb + bytes * (size_t)t;
    if (!fill_frame(exemplar, frames, rgb, t, full, error) ||
        !pack_pyramid(exemplar, full, t, error) ||
        (frames->rgb && !fl_spill_put(frames->rgb, (size_t)t, rgb, bytes, error)))
        return false;
    for (int l = 0; l < exemplar->n_levels; l++)
        fl_exemplar_level_count(&exemplar->level[l], t, own[l]);
    if (t >= exemplar->level[0].window)
        release_frames(exemplar, t, t + 1);
    return true;
}

static void merge_counts(FlExemplarFrames *frames, int t, SegmentCounts own, SegmentCounts counts)
{
    for (int l = 0; l < FL_MAX_LEVELS; l++)
        for (int s = 0; s < FL_SEGMENTS; s++)
            counts[l][s] += own[l][s];
    if (own[0][FL_SEGMENT_BORDER] == 0)
        return;
    frames->earliest = frames->earliest < 0 ? t : MIN(frames->earliest, t);
    frames->latest = MAX(frames->latest, t);
}

/* Packs every frame once, to count its segments, and keeps those of the window. */
static bool pack_frames(FlExemplar *exemplar, const FlStyle *style, FlExemplarFrames *frames,
                        SegmentCounts counts, GError **error)
{
    const int window = exemplar->level[0].window;
    GError *first = NULL;
    exemplar->separate = true; // until decide_levels()
    frames->earliest = frames->latest = -1;
#pragma omp parallel num_threads(fl_schedule_threads_up_to(PACKERS))
    {
        GError *failure = NULL;
        g_auto(FlPyramid) full = {0};
        const bool ready = fl_pyramid_init(&full, style->width, style->height, FL_PLANES, &failure);
#pragma omp for schedule(dynamic, 1)
        for (int t = 0; t < style->n_frames; t++) {
            SegmentCounts own = {{0}};
            if (!ready || failure || !pack_one(exemplar, style, frames, t, &full, own, &failure))
                continue;
#pragma omp critical
            merge_counts(frames, t, own, counts);
        }
        fl_parallel_error_keep(&first, failure);
    }
    if (window < style->n_frames)
        release_frames(exemplar, window, style->n_frames);
    return fl_parallel_error_propagate(error, first);
}

/* Decides whether segments are matched separately, and the number of levels. */
static bool decide_levels(FlExemplar *exemplar, const FlStyle *style, SegmentCounts counts,
                          GError **error)
{
    for (int l = 0; l < exemplar->n_levels; l++)
        exemplar->separate = exemplar->separate && counts[l][FL_SEGMENT_BORDER] >= MIN_SEGMENT &&
                             counts[l][FL_SEGMENT_INTERIOR] >= MIN_SEGMENT;
    for (int l = 0; l < exemplar->n_levels && !exemplar->separate; l++) {
        counts[l][FL_SEGMENT_BORDER] += counts[l][FL_SEGMENT_INTERIOR];
        for (int t = 0; t < exemplar->level[l].window; t++)
            fl_exemplar_level_merge(&exemplar->level[l], t);
    }
    while (exemplar->n_levels > 1 &&
           counts[exemplar->n_levels - 1][FL_SEGMENT_BORDER] < MIN_SEGMENT)
        exemplar->n_levels--;
    if (counts[0][FL_SEGMENT_BORDER] == 0)
        return fl_fail(error, FL_ERROR_STYLE,
                       "%s: no frame has paint in its mask; expected some pixels of it",
                       style->path);
    return true;
}

static bool init_levels(FlExemplar *exemplar, const FlStyle *style, int window, GError **error)
{
    int w = style->width, h = style->height;
    exemplar->n_levels = fl_levels_of(w, h);
    for (int l = 0; l < exemplar->n_levels; l++, w = (w + 1) / 2, h = (h + 1) / 2)
        if (!fl_exemplar_level_init(&exemplar->level[l], w, h, style->n_frames, window, error))
            return false;
    const size_t n = (size_t)style->width * (size_t)style->height * (size_t)style->n_frames;
    return (exemplar->distance = fl_alloc_lazy(n, sizeof(float), "an exemplar", error)) &&
           (exemplar->ext_plus = fl_alloc_lazy(n, sizeof(float), "an exemplar", error)) &&
           (exemplar->ext_minus = fl_alloc_lazy(n, sizeof(float), "an exemplar", error)) &&
           (exemplar->mask = fl_alloc(n, 1, "an exemplar", error));
}

static bool init_frames(FlExemplarFrames *frames, const FlStyle *style, const FlParams *params,
                        bool all, GError **error)
{
    frames->params = *params;
    return (frames->sequence = fl_style_guides(style, params, error)) &&
           (all || (frames->rgb = fl_spill_new((size_t)style->n_frames, error)));
}

/* A margin is less than a pixel of the half, of which the full one's says more. */
static bool halve_margin(FlExemplar *exemplar, const FlStyle *full, const FlParams *params,
                         GError **error)
{
    float margin_px = 0;
    if (!fl_knows_depth(params))
        return true;
    if (!measure_margin(full, 2 * exemplar->border_px, &margin_px, error))
        return false;
    exemplar->margin_px = margin_px / 2;
    return true;
}

/* full: the full-size style if `style` is its half, else NULL. */
static FlExemplar *make_exemplar(const FlStyle *style, const FlStyle *full, const FlParams *params,
                                 GError **error)
{
    fl_rotation_init();
    fl_spline_init();
    const bool all = params->style_window == 0 || params->style_window >= style->n_frames;
    g_autoptr(FlExemplar) exemplar = g_new0(FlExemplar, 1);
    g_autoptr(FlExemplarFrames) frames = g_new0(FlExemplarFrames, 1);
    SegmentCounts counts = {{0}};
    exemplar->border_px = params->border > 0 ? params->border : style->border_px;
    exemplar->smoothness = style->smoothness, exemplar->melt = style->melt;
    exemplar->wets = style->medium == FL_MEDIUM_OPAQUE || style->medium == FL_MEDIUM_BODY
                         ? 0
                         : style->front.width;
    exemplar->cut_out = style->cut_out;
    memcpy(exemplar->paper, style->paper, sizeof exemplar->paper);
    if (!init_levels(exemplar, style, all ? style->n_frames : params->style_window, error) ||
        !init_frames(frames, style, params, all, error) ||
        !measure_extents(exemplar, style, frames, error) ||
        (full && !halve_margin(exemplar, full, params, error)) ||
        !pack_frames(exemplar, style, frames, counts, error) ||
        !decide_levels(exemplar, style, counts, error))
        return NULL;
    if (!all)
        exemplar->frames = g_steal_pointer(&frames);
    for (int l = 0; l < exemplar->n_levels; l++)
        if (!fl_exemplar_level_list(&exemplar->level[l], error))
            return NULL;
    return fl_exemplar_seek(exemplar, 0, error) ? g_steal_pointer(&exemplar) : NULL;
}

FlExemplar *fl_exemplar_new(const FlStyle *style, const FlParams *params, GError **error)
{
    return make_exemplar(style, NULL, params, error);
}

/* True if there are patches in the window that no contour crosses, however they are turned. */
static bool is_deep(const FlExemplar *exemplar)
{
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t pixels = (size_t)level->width * (size_t)level->height;
    const float *distance = exemplar->distance + (size_t)level->first * pixels;
    float deepest = 0;
    for (size_t p = 0; p < pixels * (size_t)level->window; p++)
        deepest = MAX(deepest, distance[p]);
    return deepest >= 2 * FL_PATCH_RADIUS;
}

FlExemplar *fl_exemplar_new_half(const FlStyle *style, const FlParams *params, GError **error)
{
    FlParams halved = *params;
    fl_params_scale_lengths(&halved, .5f);
    g_autoptr(FlStyle) half = fl_style_halve(style, error);
    g_autoptr(FlExemplar) exemplar = half ? make_exemplar(half, style, &halved, error) : NULL;
    if (!exemplar)
        return NULL;
    if (!is_deep(exemplar))
        return fl_exemplar_new(style, params, error);
    exemplar->enlargement = fl_enlargement_new(style, &exemplar->level[0], error);
    return exemplar->enlargement ? g_steal_pointer(&exemplar) : NULL;
}

/* Packs a frame that enters the window. */
static bool pack_entering_frame(FlExemplar *exemplar, int t, GError **error)
{
    const FlExemplarFrames *frames = exemplar->frames;
    const FlExemplarLevel *level = &exemplar->level[0];
    const size_t bytes = 3 * (size_t)level->width * (size_t)level->height;
    g_auto(FlPyramid) full = {0};
    g_autofree uint8_t *rgb = fl_alloc(bytes, 1, "an exemplar", error);
    return rgb && fl_spill_get(frames->rgb, (size_t)t, rgb, bytes, error) &&
           fl_pyramid_init(&full, level->width, level->height, FL_PLANES, error) &&
           fill_frame(exemplar, frames, rgb, t, &full, error) &&
           pack_pyramid(exemplar, &full, t, error);
}

bool fl_exemplar_seek(FlExemplar *exemplar, int first, GError **error)
{
    const FlExemplarFrames *frames = exemplar->frames;
    const int old = exemplar->level[0].first, window = exemplar->level[0].window;
    if (!frames)
        return true;
    const int last = MIN(frames->latest + 1, exemplar->level[0].n_frames) - window;
    first = MAX(MIN(MAX(first, frames->earliest), last), 0);
    release_frames(exemplar, 0, first);
    release_frames(exemplar, first + window, exemplar->level[0].n_frames);
    for (int t = first; t < first + window; t++)
        if ((t < old || t >= old + window) && !pack_entering_frame(exemplar, t, error))
            return false;
    for (int l = 0; l < exemplar->n_levels && first != old; l++) {
        exemplar->level[l].first = first;
        if (!fl_exemplar_level_list(&exemplar->level[l], error))
            return false;
    }
    return !exemplar->enlargement ||
           fl_enlargement_seek(exemplar->enlargement, exemplar->level[0].first, error);
}

void fl_exemplar_free(FlExemplar *exemplar)
{
    if (!exemplar)
        return;
    for (int l = 0; l < FL_MAX_LEVELS; l++)
        fl_exemplar_level_clear(&exemplar->level[l]);
    free(exemplar->distance);
    free(exemplar->ext_plus);
    free(exemplar->ext_minus);
    free(exemplar->mask);
    frames_free(exemplar->frames);
    fl_enlargement_free(exemplar->enlargement);
    g_free(exemplar);
}
