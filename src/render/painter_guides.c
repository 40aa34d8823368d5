#include "render/painter.h"

#include "base/alloc.h"
#include "base/windows.h"
#include "guides/flow_file.h"
#include "guides/rim.h"
#include <math.h>
#include <string.h>

/* Levels that drafts have room for, as recordings of most styles have: with another style, a region
 * keeps its rectangle and its guides. */
enum { DRAFT_LEVELS = 4 };

/* ---- sources of guides --------------------------------------------------------------------- */

/* The frame of the film that has a picture of the guides. */
static int frame_of(const FlPainter *painter, int picture)
{
    const int n = painter->n_pictures;
    return (picture - painter->wrap + n) % n * painter->plan->settings.hold;
}

/* Returns: true if guides have half the size of the picture. */
static bool halves(const FlPainter *painter)
{
    return fl_field_px(painter->plan->style->exemplar) == 2;
}

/** A part of the page in px of the guides. Drafts halve the size of the guides. */
static FlRect guided_part(const FlStyleInstance *style, FlRect part)
{
    return fl_field_px(style->exemplar) == 2 ? fl_rect_halved(part) : part;
}

/* The painter's rectangle, px of the guides. */
static FlRect guided(const FlPainter *painter)
{
    return guided_part(painter->plan->style, painter->result.rect);
}

FlRect fl_painter_page(const FlPainter *painter)
{
    return (FlRect){0, 0, painter->result.width, painter->result.height};
}

/* The mask of a frame of a film that has the region as `plan`, in the painter's rectangle. */
static bool mask_in(const FlPainter *painter, const FlShapes *film, const FlRegionPlan *plan,
                    int shown, uint8_t *coverage, GError **error)
{
    if (!fl_region_lives(plan, film->drawing, shown)) {
        memset(coverage, 0, fl_rect_pixels(guided(painter)));
        return true;
    }
    return (halves(painter) ? fl_mask_store_get_half : fl_mask_store_get)(
        film->masks, plan->region, shown, painter->result.rect, coverage, error);
}

static bool film_mask(const FlPainter *painter, int shown, uint8_t *coverage, GError **error)
{
    return mask_in(painter, painter->shapes, painter->plan, shown, coverage, error);
}

static bool painter_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlPainter *painter = data;
    return !fl_stop_asked(&painter->shapes->stop, error) &&
           film_mask(painter, frame_of(painter, frame), coverage, error);
}

/* The flow into a picture, cropped to the painter's rectangle. */
static bool given_flow(const FlPainter *painter, int frame, float unknown, float *flow,
                       GError **error)
{
    const FlShapes *shapes = painter->shapes;
    const FlRect page = fl_painter_page(painter);
    g_autofree float *whole =
        fl_alloc(2 * fl_rect_pixels(page), sizeof *whole, "a flow field", error);
    if (!whole ||
        !shapes->flow(shapes->data, painter->plan, frame_of(painter, frame), unknown, whole, error))
        return false;
    if (!halves(painter)) {
        fl_rect_copy(whole, page, flow, painter->result.rect, 2 * sizeof *whole);
        return true;
    }
    const FlRect half_page = fl_rect_halved(page);
    g_autofree float *half =
        fl_alloc(2 * fl_rect_pixels(half_page), sizeof *half, "a flow field", error);
    if (!half)
        return false;
    fl_flow_halve(whole, page.width, page.height, half);
    fl_rect_copy(half, half_page, flow, guided(painter), 2 * sizeof *half);
    return true;
}

static bool painter_flow(void *data, int frame, float *flow, GError **error)
{
    return given_flow(data, frame, 0, flow, error);
}

static bool painter_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                           GError **error)
{
    return given_flow(data, frame, NAN, motion, error);
}

/* Returns: true if a picture precedes this one. The first picture has a predecessor only in a
 * loop. */
static bool has_past(const FlPainter *painter, int frame)
{
    return frame_of(painter, frame) > 0 || painter->plan->loops;
}

/* From the picture before into one. */
static FlRegionStep step_into(const FlPainter *painter, int frame, const FlOutlinePair *outlines)
{
    const int n = painter->n_pictures, hold = painter->plan->settings.hold;
    const int now = frame_of(painter, frame), last = (n - 1) * hold;
    return (FlRegionStep){painter->plan->region, now > 0 ? now - hold : last, now,
                          painter->result.rect, *outlines};
}

/* The outline of a frame, that of the frame before where both are alike; to be unref'd. */
static FlOutline *outline_in(const FlPainter *painter, const FlShapes *film,
                             const FlRegionPlan *plan, int frame, FlOutline *before, GError **error)
{
    const FlRect rect = guided(painter);
    g_autofree uint8_t *mask = fl_alloc(fl_rect_pixels(rect), 1, "a mask", error);
    if (!mask || !mask_in(painter, film, plan, frame, mask, error))
        return NULL;
    return before && fl_outline_equal(before, mask)
               ? fl_outline_ref(before)
               : fl_outline_new(mask, rect.width, rect.height, error);
}

/* The same in this film; of the two of a step it may be known. */
static FlOutline *outline_of(const FlPainter *painter, int frame, FlOutline *known,
                             FlOutline *before, GError **error)
{
    return known ? fl_outline_ref(known)
                 : outline_in(painter, painter->shapes, painter->plan, frame, before, error);
}

/* The motion of the region's fluid over a step, to be freed; it moves by each frame of the film. */
static float *fluid_motion(FlPainter *painter, const FlRegionStep *step, GError **error)
{
    const int n = painter->shapes->n_frames;
    g_autofree float *motion =
        fl_alloc_scratch(2 * fl_rect_pixels(guided(painter)), sizeof *motion, "a fluid", error);
    g_autoptr(FlOutline) last =
        motion ? outline_of(painter, step->before, step->outlines.before, NULL, error) : NULL;
    if (!last)
        return NULL;
    fl_fluid_begin(painter->fluid);
    for (int frame = step->before; frame != step->now;) {
        frame = (frame + 1) % n;
        FlOutline *known = frame == step->now ? step->outlines.now : NULL;
        g_autoptr(FlOutline) before = last;
        if (!(last = outline_of(painter, frame, known, before, error)))
            return NULL;
        fl_fluid_step(painter->fluid, before, last);
    }
    fl_fluid_motion(painter->fluid, motion);
    return g_steal_pointer(&motion);
}

/* The motion into a picture: the drawing's own, and the fluid's; unknown if none precedes it. */
static bool known_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                         GError **error)
{
    FlPainter *painter = data;
    FlRegionStep step = step_into(painter, frame, outlines);
    const size_t values = 2 * fl_rect_pixels(guided(painter));
    g_autofree float *fluid = NULL;
    for (size_t k = 0; k < values && !has_past(painter, frame); k++)
        motion[k] = NAN;
    if (!has_past(painter, frame))
        return true;
    if (painter->fluid && !(fluid = fluid_motion(painter, &step, error)))
        return false;
    step.fluid = fluid, step.wetness = (float)painter->plan->settings.wetness;
    if (painter->motion)
        return fl_motion_source_get(painter->motion, &step, motion, NULL, error);
    if (fluid)
        memcpy(motion, fluid, values * sizeof *motion);
    return true;
}

static bool has_fluid(const FlPainter *painter)
{
    return painter->plan->settings.fluid > FL_FLUID_NONE;
}

const FlRegionPlan *fl_painter_earlier(const FlPainter *painter)
{
    const FlShapes *earlier = painter->shapes->earlier;
    for (int p = 0; earlier && has_fluid(painter) && p < earlier->n_painted; p++)
        if (fl_region_is_same(&earlier->painted[p], painter->plan))
            return &earlier->painted[p];
    return NULL;
}

/* Moves the fluid by the frames before the first one. */
static bool roll_in(FlPainter *painter, GError **error)
{
    const FlShapes *shapes = painter->shapes;
    const FlRegionPlan *earlier = fl_painter_earlier(painter);
    g_autoptr(FlOutline) last = NULL;
    for (int frame = 0; earlier && frame <= shapes->n_earlier; frame++) {
        g_autoptr(FlOutline) before = last;
        if (!(last = outline_in(painter, shapes->earlier, earlier, frame, before, error)))
            return false;
        if (before)
            fl_fluid_step(painter->fluid, before, last);
    }
    return true;
}

bool fl_painter_open_fluid(FlPainter *painter, GError **error)
{
    const FlRect page = guided_part(painter->plan->style, fl_painter_page(painter));
    const FlFluidDials dials = fl_fluid_dials(&painter->plan->settings);
    fl_painter_close_fluid(painter);
    return !has_fluid(painter) ||
           ((painter->fluid = fl_fluid_new(guided(painter), page, &dials, error)) &&
            roll_in(painter, error));
}

void fl_painter_close_fluid(FlPainter *painter)
{
    g_clear_pointer(&painter->fluid, fl_fluid_free);
}

FlGuideSource fl_painter_guide_source(FlPainter *painter)
{
    const bool masks = painter->plan->settings.motion == FL_MOTION_MASKS;
    const bool given = painter->shapes->flow != NULL;
    const bool known = !masks && !given && (painter->motion || has_fluid(painter));
    const FlRect rect = guided(painter);
    return (FlGuideSource){.width = rect.width,
                           .height = rect.height,
                           .n_frames = painter->n_pictures + 2 * painter->wrap,
                           .mask = painter_mask,
                           .flow = given && masks ? painter_flow : NULL,
                           .motion = known             ? known_motion
                                     : given && !masks ? painter_motion
                                                       : NULL,
                           .data = painter};
}

int fl_guided_grid(const FlRegionPlan *region, FlRect page)
{
    const FlRect guided = guided_part(region->style, page);
    const int least = region->settings.detail == FL_DETAIL_DRAFT ? DRAFT_LEVELS : 1;
    const int levels = MAX(region->style->exemplar->n_levels, least);
    return 1 << (MIN(levels, fl_levels_of(guided.width, guided.height)) - 1);
}

int fl_guided_patches(const FlRegionPlan *region, FlRect page)
{
    return (FL_PATCH_RADIUS + 1) * fl_guided_grid(region, page);
}

/* ---- depth --------------------------------------------------------------------------------- */

/* Returns: true if the shapes that share edges with the region are the same in two frames. */
static bool joins_same(const FlPainter *painter, int a, int b)
{
    const FlSurround *surround = painter->shapes->surround;
    return !surround || fl_surround_joins_as_in(surround, painter->plan->region, a, b);
}

/* The picture around which the depth of another one is measured. A shape at rest keeps the depth
 * with which it came to rest, whatever crosses it, as its paint is kept; its depth is measured anew
 * only if shapes that share its edges move, come or go. */
static int depth_picture(FlPainter *painter, int picture)
{
    const int region = painter->plan->region, asked = picture;
    for (; picture > 0 && picture != painter->asked; picture--) {
        const int now = frame_of(painter, picture), before = frame_of(painter, picture - 1);
        if (!fl_mask_store_same(painter->shapes->masks, region, now, before) ||
            !joins_same(painter, now, before))
            break;
    }
    if (picture > 0 && picture == painter->asked)
        picture = painter->answer;
    painter->asked = asked, painter->answer = picture;
    return picture;
}

/* Blends `depth`, by weight 0..1, towards the depth of the shape united with those that share its
 * edges. may_fall: false: it only grows. */
static bool add_depth(const FlRimShape *with, float border_px, float weight, bool may_fall,
                      float *depth, GError **error)
{
    const size_t n = (size_t)with->width * (size_t)with->height;
    g_autofree float *among = fl_alloc_unset(n, sizeof *among, "a guide", error);
    if (!among || !fl_rim_depth(with, border_px, among, error))
        return false;
    for (size_t p = 0; p < n; p++)
        if (may_fall || among[p] > depth[p])
            depth[p] += weight * (among[p] - depth[p]);
    return true;
}

/* Halves in place: each pixel of the half is stored before the four pixels that it averages. */
static void halve_around(FlSurroundPlanes *around, int width, int height)
{
    uint8_t *const planes[] = {around->together, around->closed, around->seen, around->shown};
    for (size_t k = 0; k < G_N_ELEMENTS(planes); k++)
        if (planes[k])
            fl_mask_halve(planes[k], width, height, planes[k]);
}

/* The depth that the paint takes the region to have, in a frame with its shape. */
static bool measure_depth(const FlPainter *painter, int frame, FlGuides *guides, GError **error)
{
    const FlPaintedRegion *result = &painter->result;
    const FlRect place = result->rect;
    g_auto(FlSurroundPlanes) around = {0};
    const FlSurround *surround = painter->shapes->surround;
    if (surround && !fl_surround_get(surround, result->region, frame, place, &around, error))
        return false;
    if (halves(painter))
        halve_around(&around, place.width, place.height);
    const float border = result->style->exemplar->border_px;
    const FlRimShape alone = {.width = guides->width,
                              .height = guides->height,
                              .mask = guides->mask,
                              .distance = guides->distance,
                              .seen = around.hidden ? around.seen : NULL,
                              .shown = around.shown};
    FlRimShape together = alone, closed = alone;
    together.together = around.joined > 0 ? around.together : NULL;
    closed.together = around.closed, closed.seen = NULL;
    const bool all = around.joined == 0 || around.joined == 1; // in nearly all frames
    return fl_rim_depth(all ? &together : &alone, border, guides->depth, error) &&
           (all || add_depth(&together, border, around.joined, true, guides->depth, error)) &&
           // it gets no rim beside others that it would not have alone: what is narrow stays crisp
           (around.bordered == 0 ||
            add_depth(&closed, border, around.bordered, false, guides->depth, error));
}

/* The frames that paint takes to dry; 0: it does not show it. */
static int drying_frames(const FlPainter *painter)
{
    const FlEngine *engine = painter->plan->engine;
    const FlParams *params = &painter->plan->settings.params;
    return engine->drying ? engine->drying(painter->plan->style, params) : 0;
}

#define BARE_PX 4 // half the side of the window of FlGuides.bare, for a page of 480 px

/* The share of the surroundings that other figures leave bare: there an edge wets paper. */
static bool measure_bare(const FlPainter *painter, FlGuides *guides, GError **error)
{
    const FlSurround *surround = painter->shapes->surround;
    const FlRect place = painter->result.rect, whole = fl_painter_page(painter);
    const FlRect part = fl_guides_rect(guides);
    const size_t n = fl_rect_pixels(part), scale = halves(painter) ? 2 : 1;
    const int side = MAX(whole.width, whole.height) / (int)scale;
    const int reach = MAX((BARE_PX * side + 240) / 480, 1);
    if (!surround)
        return true;
    g_autofree uint16_t *lowest =
        fl_alloc_unset(fl_rect_pixels(place), sizeof *lowest, "a guide", error);
    g_autofree int16_t *outside = fl_alloc_unset(n, sizeof *outside, "a guide", error);
    g_autofree uint32_t *all = fl_alloc_unset(2 * n, sizeof *all, "a guide", error);
    if (!lowest || !outside || !all ||
        !fl_surround_lowest(surround, frame_of(painter, painter->picture), place, lowest, error))
        return false;
    for (size_t p = 0; p < n; p++)
        outside[p] = guides->mask[p] < FL_INSIDE;
    fl_window_sums(outside, part, reach, all);
    for (int y = 0; y < part.height; y++)
        for (int x = 0; x < part.width; x++) {
            const size_t p = (size_t)y * (size_t)part.width + (size_t)x;
            const size_t i = MIN(scale * (size_t)x, (size_t)place.width - 1);
            const size_t j = MIN(scale * (size_t)y, (size_t)place.height - 1);
            outside[p] = outside[p] && lowest[j * (size_t)place.width + i] == 0;
        }
    fl_window_sums(outside, part, reach, all + n);
    for (size_t p = 0; p < n; p++)
        guides->bare[p] = (uint8_t)(255 * all[n + p] / MAX(all[p], 1));
    return true;
}

/* Returns: true if paint may still dry after its last motion. */
static bool may_dry(const FlPainter *painter)
{
    const int first = MAX(painter->picture - drying_frames(painter), 1);
    bool moved = false;
    for (int f = first; f < painter->picture && !moved; f++)
        moved = !fl_guide_sequence_rests(painter->sequence, f);
    return moved;
}

/* ---- the guides of a picture ---------------------------------------------------------------- */

bool fl_painter_rests(FlPainter *painter, int last)
{
    const int now = painter->picture;
    const bool blended = painter->loop.n > 0 && last - painter->wrap >= painter->loop.first;
    return now == last + 1 && !blended && painter->plan->engine->rest && !may_dry(painter) &&
           fl_guide_sequence_rests(painter->sequence, now) &&
           (!fl_knows_depth(&painter->plan->settings.params) ||
            depth_picture(painter, last) == depth_picture(painter, now));
}

/* The control map of the engine's dial. */
static bool read_map(const FlPainter *painter, FlGuides *guides, GError **error)
{
    FlControlMap *const *map = painter->plan->map;
    const FlRect page = guided_part(painter->plan->style, fl_painter_page(painter));
    FlControlMap *own = map[FL_MAP_CARRY] ? map[FL_MAP_CARRY] : map[FL_MAP_STRENGTH];
    return !own ||
           fl_control_map_make(
               own,
               fl_drawing_number(painter->shapes->drawing, frame_of(painter, painter->picture)),
               guided(painter), page.width, page.height, &guides->share, error);
}

/* The depth takes as much scratch as the other planes, which are made later. Guides of some presets
 * lack a depth. */
bool fl_painter_make_guides(FlPainter *painter, GError **error)
{
    FlGuides *guides = &painter->guides;
    const FlRect rect = guided(painter);
    const int picture = painter->picture;
    const bool deep = fl_knows_depth(&painter->plan->settings.params);
    if (!fl_guides_init(guides, rect.width, rect.height, error))
        return false;
    guides->disposable = !painter->wants_guides;
    return fl_guide_sequence_distance(painter->sequence, picture, guides, error) &&
           (!deep || measure_depth(painter, frame_of(painter, depth_picture(painter, picture)),
                                   guides, error)) &&
           fl_guide_sequence_planes(painter->sequence, picture, guides, error) &&
           (!drying_frames(painter) || measure_bare(painter, guides, error)) &&
           read_map(painter, guides, error);
}

void fl_painter_drop_guides(FlPainter *painter)
{
    fl_guides_clear(&painter->guides);
}
