#include "synth/exemplar.h"

#include "base/alloc.h"
#include "style/adapt.h"
#include "synth/spline.h"
#include <string.h>

#define MIN_SEGMENT 25 // pixels; with fewer on a level, segments are not told apart

int fl_levels_of(int width, int height)
{
    int levels = 0;
    for (int side = MIN(width, height) / FL_PATCH; side > 1; side /= 2)
        levels++;
    return CLAMP(levels, 1, FL_MAX_LEVELS);
}

FlGuideParams fl_guide_params(const FlParams *params)
{
    const float part = params->half_size ? 0.5f : 1;
    return (FlGuideParams){.flow_sigma_frames = params->flow_sigma,
                           .dist_sigma_frames = params->time_blur_sigma,
                           .dist_sigma_px = params->blur_sigma * part,
                           .still_px = params->flow_still * part,
                           .flow_limit = params->flow_limit};
}

bool fl_shape_guide(const FlGuides *guides, const FlParams *params, float border_px, float *shape,
                    GError **error)
{
    if (params->shape_ramp)
        fl_shape_ramp(guides->distance, guides->width, guides->height, border_px, shape);
    else if (params->shape_edge > 0)
        fl_shape_edge(guides->distance, guides->width, guides->height, border_px,
                      params->shape_edge * border_px, shape);
    else
        return fl_shape_blur(guides->mask, guides->width, guides->height, border_px, shape, error);
    return true;
}

static bool style_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlStyle *style = data;
    const size_t pixels = (size_t)style->width * style->height;
    memcpy(coverage, style->mask + frame * pixels, pixels);
    return true;
}

static bool style_flow(void *data, int frame, float *flow, GError **error)
{
    const FlStyle *style = data;
    const size_t values = 2 * (size_t)style->width * style->height;
    memcpy(flow, style->flow + frame * values, values * sizeof *flow);
    return true;
}

static bool keep_guides(FlExemplar *exemplar, const FlGuides *guides, int t, size_t pixels)
{
    memcpy(exemplar->distance + t * pixels, guides->distance, pixels * sizeof(float));
    memcpy(exemplar->ext_plus + t * pixels, guides->ext_plus, pixels * sizeof(float));
    memcpy(exemplar->ext_minus + t * pixels, guides->ext_minus, pixels * sizeof(float));
    memcpy(exemplar->mask + t * pixels, guides->mask, pixels);
    return true;
}

/* Level 0 of one frame: its guides, and its colours. */
static bool fill_frame(FlExemplar *exemplar, const FlStyle *style, const FlParams *params,
                       const FlGuideSequence *sequence, int t, FlStack *stack, GError **error)
{
    const size_t pixels = (size_t)style->width * style->height;
    g_auto(FlGuides) guides = {0};
    float *shape = stack->plane[FL_PLANE_R]; // lent until the colours are there
    if (!fl_guides_init(&guides, style->width, style->height, error) ||
        !fl_guide_sequence_get(sequence, t, &guides, error) ||
        !fl_shape_guide(&guides, params, exemplar->border_px, shape, error))
        return false;
    keep_guides(exemplar, &guides, t, pixels);
    fl_stack_fill(stack, &guides, shape, (FlRect){0, 0, style->width, style->height});
    const uint8_t *rgb = style->rgb + 3 * pixels * t;
    for (int c = 0; c < 3; c++)
        for (size_t p = 0; p < pixels; p++)
            stack->plane[FL_PLANE_R + c][p] = rgb[3 * p + c] / 255.0f;
    return true;
}

static FlTexel pack(const FlStack *stack, size_t p, const FlExemplar *exemplar)
{
    FlTexel out;
    const float ext_scale = exemplar->ext_scale * FL_EXT_UNIT;
    for (int c = 0; c < 3; c++)
        out.c[FL_CH_R + c] = fl_texel_channel(stack->plane[FL_PLANE_R + c][p]);
    out.c[FL_CH_SHAPE] = fl_texel_channel(stack->plane[FL_PLANE_SHAPE][p]);
    out.c[FL_CH_EXT_PLUS] = fl_texel_channel(stack->plane[FL_PLANE_EXT_PLUS][p] * ext_scale);
    out.c[FL_CH_EXT_MINUS] = fl_texel_channel(stack->plane[FL_PLANE_EXT_MINUS][p] * ext_scale);
    out.c[FL_CH_ANGLE] = fl_stack_angle(stack, p);
    out.c[FL_CH_SEGMENT] =
        (uint8_t)fl_segment_of(stack->plane[FL_PLANE_INSIDE][p] >= 0.5f,
                               stack->plane[FL_PLANE_DISTANCE][p], exemplar->border_px, true);
    return out;
}

/* Padding repeats the nearest pixel but belongs to no segment. */
static void pack_frame(FlExemplarLevel *level, const FlStack *stack, const FlExemplar *exemplar,
                       int t)
{
    FlTexel *frame = level->pixels + t * level->frame_pixels;
    for (int y = -FL_PAD; y < level->height + FL_PAD; y++) {
        for (int x = -FL_PAD; x < level->width + FL_PAD; x++) {
            const int sx = CLAMP(x, 0, level->width - 1), sy = CLAMP(y, 0, level->height - 1);
            FlTexel packed = pack(stack, (size_t)sy * level->width + sx, exemplar);
            if (sx != x || sy != y)
                packed.c[FL_CH_SEGMENT] = FL_SEGMENT_OUTSIDE;
            frame[(size_t)(y + FL_PAD) * level->pitch + x + FL_PAD] = packed;
        }
    }
}

/* The colours' spline coefficients; `room` is for three planes. */
static void pack_colour(FlExemplarLevel *level, const FlStack *stack, int t, float *room)
{
    const size_t pixels = (size_t)level->width * level->height;
    float *const plane[3] = {room, room + pixels, room + 2 * pixels};
    for (int c = 0; c < 3; c++)
        memcpy(plane[c], stack->plane[FL_PLANE_R + c], pixels * sizeof(float));
    fl_spline_prefilter(plane, level->width, level->height,
                        level->colour + t * level->frame_pixels + FL_PAD * level->pitch + FL_PAD,
                        (int)level->pitch);
}

/* Rotated offsets to the nearest pixel; half a turn negates them. */
static void rotate_offsets(FlExemplarLevel *level)
{
    for (int a = 0; a < FL_ANGLES / 2; a++)
        for (int p = 0; p < FL_PATCH_PIXELS; p += 2) {
            int x, y;
            fl_unrotate((uint8_t)a, fl_patch_offsets[p][0], fl_patch_offsets[p][1], &x, &y);
            const int offset = ((y + 8) >> 4) * (int)level->pitch + ((x + 8) >> 4);
            level->offsets[a][p] = level->offsets[a + FL_ANGLES / 2][p + 1] = (int16_t)offset;
            level->offsets[a][p + 1] = level->offsets[a + FL_ANGLES / 2][p] = (int16_t)-offset;
        }
}

static bool level_init(FlExemplarLevel *level, int width, int height, int n_frames, GError **error)
{
    level->width = width, level->height = height, level->n_frames = n_frames;
    level->pitch = (size_t)width + 2 * FL_PAD;
    level->frame_pixels = level->pitch * (height + 2 * FL_PAD);
    level->pixels =
        fl_alloc_huge(level->frame_pixels * n_frames, sizeof(FlTexel), "an exemplar", error);
    level->colour = level->pixels ? fl_alloc_huge(level->frame_pixels * n_frames,
                                                  sizeof(FlSplinePixel), "an exemplar", error)
                                  : NULL;
    level->offsets =
        level->colour ? fl_alloc(FL_ANGLES, sizeof *level->offsets, "an exemplar", error) : NULL;
    if (!level->offsets)
        return false;
    rotate_offsets(level);
    return true;
}

static FlSegment segment_at(const FlExemplarLevel *level, int x, int y, int t)
{
    return fl_exemplar_at(level, x, y, t)->c[FL_CH_SEGMENT];
}

/* Lists the pixels of each segment, or of the whole mask as border where they are not separate. */
static bool list_valid(FlExemplarLevel *level, bool separate, GError **error)
{
    size_t count[FL_SEGMENTS] = {0};
    for (int t = 0; t < level->n_frames; t++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                FlTexel *pixel = (FlTexel *)fl_exemplar_at(level, x, y, t);
                if (!separate && pixel->c[FL_CH_SEGMENT] == FL_SEGMENT_INTERIOR)
                    pixel->c[FL_CH_SEGMENT] = FL_SEGMENT_BORDER;
                count[pixel->c[FL_CH_SEGMENT]]++;
            }
    for (FlSegment s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++)
        if (!(level->valid[s] = fl_alloc(count[s], sizeof(uint32_t), "an exemplar", error)))
            return false;
    for (int t = 0; t < level->n_frames; t++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++) {
                const FlSegment s = segment_at(level, x, y, t);
                if (s != FL_SEGMENT_OUTSIDE)
                    level->valid[s][level->n_valid[s]++] =
                        (uint32_t)(((size_t)t * level->height + y) * level->width + x);
            }
    return true;
}

static bool enough_of_each_segment(const FlExemplarLevel *level)
{
    size_t count[FL_SEGMENTS] = {0};
    for (int t = 0; t < level->n_frames; t++)
        for (int y = 0; y < level->height; y++)
            for (int x = 0; x < level->width; x++)
                count[segment_at(level, x, y, t)]++;
    return count[FL_SEGMENT_BORDER] >= MIN_SEGMENT && count[FL_SEGMENT_INTERIOR] >= MIN_SEGMENT;
}

static void scale_extents(FlExemplar *exemplar, const FlStyle *style)
{
    const size_t pixels = (size_t)style->width * style->height * style->n_frames;
    float most = 0;
    for (size_t p = 0; p < pixels; p++)
        most = MAX(most, MAX(exemplar->ext_plus[p], exemplar->ext_minus[p]));
    exemplar->ext_scale = most > 0 ? 1 / most : 1;
}

/* Builds every level of one frame from its level 0. */
static bool pack_pyramid(FlExemplar *exemplar, FlStack *full, int t, GError **error)
{
    g_autofree float *room =
        fl_alloc(3 * (size_t)full->width * full->height, sizeof *room, "an exemplar", error);
    if (!room)
        return false;
    pack_frame(&exemplar->level[0], full, exemplar, t);
    pack_colour(&exemplar->level[0], full, t, room);
    g_auto(FlStack) fine = {0};
    for (int l = 1; l < exemplar->n_levels; l++) {
        FlExemplarLevel *level = &exemplar->level[l];
        FlStack coarse;
        if (!fl_stack_init(&coarse, level->width, level->height, FL_PLANES, error))
            return false;
        fl_stack_halve(l == 1 ? full : &fine, &coarse);
        fl_stack_clear(&fine);
        fine = coarse;
        pack_frame(level, &fine, exemplar, t);
        pack_colour(level, &fine, t, room);
    }
    return true;
}

static bool build_levels(FlExemplar *exemplar, const FlStyle *style, const FlParams *params,
                         const FlGuideSequence *sequence, GError **error)
{
    int w = style->width, h = style->height;
    for (int l = 0; l < exemplar->n_levels; l++, w = (w + 1) / 2, h = (h + 1) / 2)
        if (!level_init(&exemplar->level[l], w, h, style->n_frames, error))
            return false;
    g_auto(FlStack) full = {0};
    if (!fl_stack_init(&full, style->width, style->height, FL_PLANES, error))
        return false;
    for (int t = 0; t < style->n_frames; t++) // the extents of all frames give the scale
        if (!fill_frame(exemplar, style, params, sequence, t, &full, error))
            return false;
    scale_extents(exemplar, style);
    for (int t = 0; t < style->n_frames; t++)
        if (!fill_frame(exemplar, style, params, sequence, t, &full, error) ||
            !pack_pyramid(exemplar, &full, t, error))
            return false;
    return true;
}

static bool list_all_valid(FlExemplar *exemplar, const FlStyle *style, GError **error)
{
    exemplar->separate = true;
    for (int l = 0; l < exemplar->n_levels; l++)
        exemplar->separate = exemplar->separate && enough_of_each_segment(&exemplar->level[l]);
    for (int l = 0; l < exemplar->n_levels; l++)
        if (!list_valid(&exemplar->level[l], exemplar->separate, error))
            return false;
    while (exemplar->n_levels > 1 &&
           exemplar->level[exemplar->n_levels - 1].n_valid[FL_SEGMENT_BORDER] < MIN_SEGMENT)
        exemplar->n_levels--;
    if (exemplar->level[0].n_valid[FL_SEGMENT_BORDER] == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                    "%s: no frame has paint in its mask; expected some pixels of it", style->path);
        return false;
    }
    return true;
}

static FlExemplar *exemplar_of(const FlStyle *style, const FlParams *params, float scale,
                               GError **error)
{
    fl_rotation_init();
    fl_spline_init();
    g_autoptr(FlExemplar) exemplar = g_new0(FlExemplar, 1);
    const size_t pixels = (size_t)style->width * style->height * style->n_frames;
    exemplar->n_levels = fl_levels_of(style->width, style->height);
    exemplar->border_px = params->border > 0 ? params->border * scale : style->border_px;
    memcpy(exemplar->paper, style->paper, sizeof exemplar->paper);
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {.width = style->width,
                                  .height = style->height,
                                  .n_frames = style->n_frames,
                                  .mask = style_mask,
                                  .flow = style->flow ? style_flow : NULL,
                                  .data = (void *)style};
    g_autoptr(FlGuideSequence) sequence = fl_guide_sequence_new(&source, &how, error);
    if (!sequence ||
        !(exemplar->distance = fl_alloc(pixels, sizeof(float), "an exemplar", error)) ||
        !(exemplar->ext_plus = fl_alloc(pixels, sizeof(float), "an exemplar", error)) ||
        !(exemplar->ext_minus = fl_alloc(pixels, sizeof(float), "an exemplar", error)) ||
        !(exemplar->mask = fl_alloc(pixels, 1, "an exemplar", error)) ||
        !build_levels(exemplar, style, params, sequence, error) ||
        !list_all_valid(exemplar, style, error))
        return NULL;
    return g_steal_pointer(&exemplar);
}

FlExemplar *fl_exemplar_new(const FlStyle *style, const FlParams *params, GError **error)
{
    if (!params->half_size)
        return exemplar_of(style, params, 1, error);
    const FlStyleUse half = {.start = 1, .step = 1, .scale = 0.5f};
    g_autoptr(FlStyle) small = fl_style_adapt(style, &half, error);
    return small ? exemplar_of(small, params, half.scale, error) : NULL;
}

void fl_exemplar_free(FlExemplar *exemplar)
{
    if (!exemplar)
        return;
    for (int l = 0; l < FL_MAX_LEVELS; l++) {
        FlExemplarLevel *level = &exemplar->level[l];
        free(level->pixels);
        free(level->colour);
        free(level->offsets);
        for (int s = 0; s < FL_SEGMENTS; s++)
            free(level->valid[s]);
    }
    free(exemplar->distance);
    free(exemplar->ext_plus);
    free(exemplar->ext_minus);
    free(exemplar->mask);
    g_free(exemplar);
}
