#include "render/painter.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "guides/flow_file.h"
#include "guides/half_guides.h"
#include "guides/rim.h"
#include "io/pattern.h"
#include "job/paint_files.h"
#include <math.h>
#include <string.h>

#define NONE (-1) // before the first picture, and after those of an earlier render
#define WRAP 24   // pictures of a loop that guides use beyond each end

/* The frame of the film that has a picture of the guides. */
static int frame_of(const FlPainter *painter, int picture)
{
    const int n = painter->n_pictures;
    return (picture - painter->wrap + n) % n * painter->plan->settings.hold;
}

/* Whether guides have half the size of the picture. */
static bool halves(const FlPainter *painter)
{
    return painter->plan->style->enlargement != NULL;
}

/* A part of the page in px of the guides. */
static FlRect in_guides(const FlStyleInstance *style, FlRect part)
{
    return style->enlargement ? fl_rect_halved(part) : part;
}

/* That which is painted. */
static FlRect guided_rect(const FlPainter *painter)
{
    return in_guides(painter->plan->style, painter->result.rect);
}

static FlRect page_of(const FlPainter *painter)
{
    return (FlRect){0, 0, painter->result.width, painter->result.height};
}

static bool painter_mask(void *data, int frame, uint8_t *coverage, GError **error)
{
    const FlPainter *painter = data;
    const FlRect rect = painter->result.rect;
    const int region = painter->plan->region, shown = frame_of(painter, frame);
    return halves(painter)
               ? fl_mask_store_get_half(painter->masks, region, shown, rect, coverage, error)
               : fl_mask_store_get(painter->masks, region, shown, rect, coverage, error);
}

/* The flow of the whole frame; files have the size of the output, which drafts halve. */
static bool load_flow(const FlPainter *painter, const char *file, float unknown, float *flow,
                      GError **error)
{
    const int width = painter->frame_width, height = painter->frame_height;
    if (width == painter->result.width && height == painter->result.height)
        return fl_flow_load(file, width, height, unknown, flow, error);
    g_autofree float *full =
        fl_alloc(2 * (size_t)width * height, sizeof(float), "a flow field", error);
    if (!full || !fl_flow_load(file, width, height, unknown, full, error))
        return false;
    fl_flow_halve(full, width, height, flow);
    return true;
}

/* Of nothing into the first frame: who writes a flow between frames has no file for it. */
static bool may_lack_flow(const FlPainter *painter, int frame, const char *file)
{
    return frame_of(painter, frame) == 0 && !painter->plan->loops &&
           !g_file_test(file, G_FILE_TEST_EXISTS);
}

/* The flow of a picture from its file, cropped to the painter's rectangle. */
static bool flow_in_file(const FlPainter *painter, int frame, float unknown, float *flow,
                         GError **error)
{
    const int number = fl_drawing_number(painter->drawing, frame_of(painter, frame));
    const size_t pixels = (size_t)painter->result.width * painter->result.height;
    g_autofree float *whole = fl_alloc(2 * pixels, sizeof(float), "a flow field", error);
    g_autofree char *file =
        whole ? fl_output_name(painter->plan->flow_files, number, painter->plan->name, error)
              : NULL;
    if (!file)
        return false;
    if (may_lack_flow(painter, frame, file))
        for (size_t k = 0; k < 2 * pixels; k++)
            whole[k] = unknown;
    else if (!load_flow(painter, file, unknown, whole, error))
        return false;
    const FlRect page = page_of(painter);
    if (!halves(painter)) {
        fl_rect_copy(whole, page, flow, painter->result.rect, 2 * sizeof(float));
        return true;
    }
    const FlRect half_page = fl_rect_halved(page);
    g_autofree float *half =
        fl_alloc(2 * fl_rect_pixels(half_page), sizeof(float), "a flow field", error);
    if (!half)
        return false;
    fl_flow_halve(whole, page.width, page.height, half);
    fl_rect_copy(half, half_page, flow, guided_rect(painter), 2 * sizeof(float));
    return true;
}

static bool painter_flow(void *data, int frame, float *flow, GError **error)
{
    return flow_in_file(data, frame, 0, flow, error);
}

static bool painter_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                           GError **error)
{
    return flow_in_file(data, frame, NAN, motion, error);
}

/* The drawing's own motion into a picture. Nothing comes before the first one, but in a loop. */
static bool exact_motion(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                         GError **error)
{
    const FlPainter *painter = data;
    const int n = painter->n_pictures, hold = painter->plan->settings.hold;
    const int now = frame_of(painter, frame), last = (n - 1) * hold;
    const int before = now > 0 ? now - hold : last;
    const size_t values = 2 * fl_rect_pixels(guided_rect(painter));
    if (now == 0 && !painter->plan->loops) {
        for (size_t k = 0; k < values; k++)
            motion[k] = NAN;
        return true;
    }
    const FlRegionStep step = {painter->plan->region, before, now, painter->result.rect, *outlines};
    return fl_motion_source_get(painter->motion, &step, motion, NULL, error);
}

/* The source of the guides: the masks within the painter's rectangle, and the motion. Flow files
 * replace the flow from the masks under motion = masks, else carry the paint. */
static FlGuideSource source_of(FlPainter *painter)
{
    const bool masks = painter->plan->settings.motion == FL_MOTION_MASKS;
    const bool files = painter->plan->flow_files != NULL;
    const FlRect rect = guided_rect(painter);
    return (FlGuideSource){.width = rect.width,
                           .height = rect.height,
                           .n_frames = painter->n_pictures + 2 * painter->wrap,
                           .mask = painter_mask,
                           .flow = files && masks ? painter_flow : NULL,
                           .motion = masks   ? NULL
                                     : files ? painter_motion
                                             : exact_motion,
                           .data = painter,
                           .keeps_flow = painter->plan->keeps_flow};
}

/* The grid of the coarsest level, px of the guides. */
static int coarsest_grid(const FlStyleInstance *style, FlRect page)
{
    const FlRect guided = in_guides(style, page);
    return 1 << (MIN(style->exemplar->n_levels, fl_levels_of(guided.width, guided.height)) - 1);
}

/* How far patches of the coarsest level reach, and its grid, px of the guides. */
static int patches_px(const FlStyleInstance *style, FlRect page)
{
    return (FL_PATCH_RADIUS + 1) * coarsest_grid(style, page);
}

FlRect fl_painter_crop(FlRect extent, FlRect page, const FlStyleInstance *style)
{
    const int scale = style->enlargement ? 2 : 1;
    const FlRect grown = fl_rect_grown(extent, scale * patches_px(style, page), page);
    return fl_rect_on_grid(grown, scale * coarsest_grid(style, page));
}

static FlRect cropped(const FlPainter *painter)
{
    const FlRect extent = fl_mask_store_extent(painter->masks, painter->plan->region);
    const FlRect page = page_of(painter);
    return fl_painter_crop(fl_rect_grown(extent, (int)ceilf(painter->result.reach_px), page), page,
                           painter->plan->style);
}

/* Measured: the packed state, and what packing leaves of a picture; bare paper takes little. */
double fl_painter_bytes(const FlPainter *painter, bool packed)
{
    const double rect = (double)fl_rect_pixels(painter->result.rect);
    return 10 * MIN(painter->plan->area_px, rect) + (packed ? 0 : 3 * rect);
}

static bool is_known(const FlPainter *painter)
{
    return painter->reuse && painter->reuse->known;
}

/* Whether no frame shows anything of the region: then it has no paint, no guides and no room. */
static bool is_hidden(const FlPainter *painter, const FlPlan *plan)
{
    return is_known(painter) ? painter->reuse->known->len == 0
                             : fl_plan_hides(plan, painter->plan->region);
}

void fl_painter_init(FlPainter *painter, const FlPlan *plan, const FlRegionPlan *region,
                     FlReuse *reuse)
{
    *painter = (FlPainter){.plan = region,
                           .picture = NONE,
                           .masks = plan->masks,
                           .surround = plan->surround,
                           .drawing = plan->drawing,
                           .frame_width = plan->width,
                           .frame_height = plan->height,
                           .result = {.region = region->region,
                                      .name = region->name,
                                      .settings = &region->settings,
                                      .style = region->style,
                                      .width = fl_drawing_width(plan->drawing),
                                      .height = fl_drawing_height(plan->drawing)}};
    if (region->engine->exposure)
        painter->result.exposure = region->engine->exposure(region->style);
    if (region->engine->reach)
        painter->result.reach_px = region->engine->reach(region->style, &region->settings.params);
    painter->n_pictures = (fl_drawing_frames(plan->drawing) - 1) / region->settings.hold + 1;
    painter->wrap = region->loops ? MIN(painter->n_pictures, WRAP) : 0;
    painter->reuse = reuse;
    painter->result.unseen = is_hidden(painter, plan);
    if (!painter->result.unseen)
        painter->result.rect = is_known(painter)         ? reuse->rect
                               : region->place.width > 0 ? region->place
                                                         : cropped(painter);
}

bool fl_painter_prepare(FlPainter *painter, uint64_t seed, GError **error)
{
    const FlRegionPlan *plan = painter->plan;
    if (painter->result.unseen)
        return true;
    if (plan->loops && !fl_loop_init(&painter->loop, painter->n_pictures, error))
        return false;
    if (plan->paint_files || is_known(painter))
        return true;
    if (painter->reuse && painter->reuse->cache)
        fl_reuse_begin(painter->reuse, painter->result.rect);
    const FlRect rect = guided_rect(painter), page = in_guides(plan->style, page_of(painter));
    const FlGuideSource source = source_of(painter);
    const FlGuideParams params = fl_guide_params(&plan->settings.params);
    const FlEngineInput input = {plan->style,
                                 plan->tile,
                                 &plan->settings,
                                 {rect.width, rect.height, page.width, page.height},
                                 painter->result.rect.width,
                                 painter->result.rect.height,
                                 fl_key(seed, g_str_hash(plan->name))};
    return (painter->guides = fl_guide_sequence_new(&source, &params, error)) &&
           (painter->paint = plan->engine->open(&input, error));
}

void fl_painter_clear(FlPainter *painter)
{
    fl_guide_sequence_free(painter->guides);
    if (painter->paint)
        painter->plan->engine->close(painter->paint);
    fl_loop_clear(&painter->loop);
    fl_painted_clear(&painter->result);
    *painter = (FlPainter){0};
}

/* The picture around which the depth of another one is measured. A shape at rest keeps the depth
 * with which it came to rest, whatever crosses it, as its paint is kept; only where those that it
 * shares edges with move, come or go is it measured anew. */
static int depth_picture(FlPainter *painter, int picture)
{
    const int region = painter->plan->region, asked = picture;
    for (; picture > 0 && picture != painter->asked; picture--) {
        const int now = frame_of(painter, picture), before = frame_of(painter, picture - 1);
        if (!fl_mask_store_same(painter->masks, region, now, before) ||
            !fl_surround_joins_as_in(painter->surround, region, now, before))
            break;
    }
    if (picture > 0 && picture == painter->asked)
        picture = painter->answer;
    painter->asked = asked, painter->answer = picture;
    return picture;
}

/* No rim where others border on the shape; but it gets none that it would not have alone, since
 * what is narrow by itself stays crisp beside whatever it is. */
static bool close_depth(const FlRimShape *alone, const uint8_t *closed, float border_px,
                        float *depth, GError **error)
{
    const size_t n = (size_t)alone->width * (size_t)alone->height;
    g_autofree float *with_others = fl_alloc_unset(n, sizeof *with_others, "a guide", error);
    FlRimShape shape = *alone;
    shape.together = closed, shape.seen = NULL;
    if (!with_others || !fl_rim_depth(&shape, border_px, with_others, error))
        return false;
    for (size_t p = 0; p < n; p++)
        depth[p] = MAX(depth[p], with_others[p]);
    return true;
}

/* In place: a pixel of the half lies before the four that it is made of. */
static void halve_around(FlAround *around, int width, int height)
{
    uint8_t *const planes[] = {around->together, around->closed, around->seen, around->shown};
    for (size_t k = 0; k < G_N_ELEMENTS(planes); k++)
        if (planes[k])
            fl_mask_halve(planes[k], width, height, planes[k]);
}

/* The place on the page of what guides are of. */
static FlRect guided_place(const FlPainter *painter, const FlGuides *guides)
{
    const FlRect whole = guided_rect(painter);
    const FlRect place = {whole.x + guides->x, whole.y + guides->y, guides->width, guides->height};
    return halves(painter)
               ? fl_rect_and(fl_rect_doubled(place, page_of(painter)), painter->result.rect)
               : place;
}

static bool measure_depth(const FlPainter *painter, int frame, FlGuides *guides, GError **error)
{
    const FlPaintedRegion *result = &painter->result;
    const FlRect place = guided_place(painter, guides);
    g_auto(FlAround) around = {0};
    if (!fl_surround_get(painter->surround, result->region, frame, place, &around, error))
        return false;
    if (halves(painter))
        halve_around(&around, place.width, place.height);
    const FlRimShape shape = {.width = guides->width,
                              .height = guides->height,
                              .mask = guides->mask,
                              .distance = guides->distance,
                              .together = around.joined ? around.together : NULL,
                              .seen = around.hidden ? around.seen : NULL,
                              .shown = around.shown};
    const float border = result->style->exemplar->border_px;
    return fl_rim_depth(&shape, border, guides->depth, error) &&
           (!around.bordered || close_depth(&shape, around.closed, border, guides->depth, error));
}

/* The depth that the paint takes the region to have, unless a preset's guides know none. */
static bool make_depth(FlPainter *painter, FlGuides *guides, GError **error)
{
    return !fl_knows_depth(&painter->plan->settings.params) ||
           measure_depth(painter, frame_of(painter, depth_picture(painter, painter->picture)),
                         guides, error);
}

/* Whether the picture has the guides of the one before, which result.painted still shows. */
static bool rests(FlPainter *painter, int last)
{
    const int now = painter->picture;
    const bool blended = painter->loop.n > 0 && last - painter->wrap >= painter->loop.first;
    return now == last + 1 && !blended && painter->plan->engine->rest &&
           fl_guide_sequence_rests(painter->guides, now) &&
           (!fl_knows_depth(&painter->plan->settings.params) ||
            depth_picture(painter, last) == depth_picture(painter, now));
}

/* Whether the engine keeps parts at rest in the picture. */
static bool keeps_parts(const FlPainter *painter)
{
    const FlParams *params = &painter->plan->settings.params;
    return painter->follows && painter->plan->engine->rest && params->rest && params->boil == 0;
}

/* A square of the guides' frame stirs if a shape with which the region shares edges differs in px
 * around it: there its depth may change. */
static void stir_around(uint8_t *square, FlRect guided, FlRect px)
{
    const int columns = fl_rest_squares(guided.width);
    const FlRect around = fl_rect_and(px, (FlRect){0, 0, guided.width, guided.height});
    for (int y = around.y / FL_REST_PX; y < fl_rest_squares(around.y + around.height); y++)
        for (int x = around.x / FL_REST_PX; x < fl_rest_squares(around.x + around.width); x++)
            if (square[y * columns + x])
                square[y * columns + x] |= FL_REST_STIRS;
}

static bool stir_joins(const FlPainter *painter, uint8_t *square, GError **error)
{
    const int region = painter->plan->region, scale = halves(painter) ? 2 : 1;
    const int now = frame_of(painter, painter->picture);
    const int before = frame_of(painter, painter->picture - 1);
    const FlRect rect = painter->result.rect, guided = guided_rect(painter);
    const int reach = fl_rim_reach(painter->plan->style->exemplar->border_px) + FL_REST_PX;
    if (fl_surround_joins_as_in(painter->surround, region, now, before))
        return true;
    g_autofree uint8_t *differs = fl_alloc_unset(fl_rect_pixels(rect), 1, "a mask", error);
    if (!differs ||
        !fl_surround_differs(painter->surround, region, now, before, rect, differs, error))
        return false;
    for (int y = 0; y < guided.height; y += FL_REST_PX)
        for (int x = 0; x < guided.width; x += FL_REST_PX) {
            const FlRect px = {scale * x, scale * y, scale * FL_REST_PX, scale * FL_REST_PX};
            const FlRect cell = fl_rect_and(px, (FlRect){0, 0, rect.width, rect.height});
            if (fl_rect_within(differs, rect.width, cell).width > 0)
                stir_around(
                    square, guided,
                    (FlRect){x - reach, y - reach, FL_REST_PX + 2 * reach, FL_REST_PX + 2 * reach});
        }
    return true;
}

/* Parts whose mask and motion say that they rest, and with whose depth nothing interferes; the
 * engine looks at the others. moving: their rectangle, or that of all. */
static bool find_resting(const FlPainter *painter, FlRestingParts *resting, FlRect *moving,
                         GError **error)
{
    const FlRect rect = guided_rect(painter);
    *moving = (FlRect){0, 0, rect.width, rect.height};
    g_autofree uint8_t *square = NULL;
    if (!keeps_parts(painter))
        return true;
    if (!fl_guide_sequence_stirring(painter->guides, painter->picture, &square, error))
        return false;
    return !square ||
           ((!fl_knows_depth(&painter->plan->settings.params) ||
             stir_joins(painter, square, error)) &&
            fl_resting_parts_init(resting, rect.width, rect.height, square, moving, error));
}

/* The part of the frame that guides are needed of: with all that they depend on there. */
static FlRect needed_part(const FlPainter *painter, FlRect moving)
{
    const FlStyleInstance *style = painter->plan->style;
    const FlRect rect = guided_rect(painter), whole = {0, 0, rect.width, rect.height};
    const int patches = patches_px(style, page_of(painter));
    return fl_rect_grown(moving, MAX(patches, fl_rim_reach(style->exemplar->border_px)), whole);
}

/* The depth takes as much scratch as the other planes, which come after it. */
static bool fill_guides(FlPainter *painter, FlRect part, FlGuides *guides, GError **error)
{
    if (!fl_guides_init(guides, part.width, part.height, error))
        return false;
    guides->x = part.x, guides->y = part.y;
    return fl_guide_sequence_distance(painter->guides, painter->picture, guides, error) &&
           make_depth(painter, guides, error) &&
           fl_guide_sequence_planes(painter->guides, painter->picture, guides, error);
}

/* The guides of the painter's picture, for whoever looks at them, and those from which the engine
 * paints it: the same, or of the part that does not rest. */
static bool make_guides(FlPainter *painter, FlGuides *guides, FlGuides *part, GError **error)
{
    g_auto(FlRestingParts) resting = {0};
    const FlRect rect = guided_rect(painter), whole = {0, 0, rect.width, rect.height};
    FlRect moving;
    if (!find_resting(painter, &resting, &moving, error))
        return false;
    if ((!resting.keeps || painter->wants_guides) && !fill_guides(painter, whole, guides, error))
        return false;
    guides->disposable = !painter->wants_guides;
    if (!resting.keeps)
        return true;
    if (!fill_guides(painter, needed_part(painter, moving), part, error))
        return false;
    part->resting = resting, resting = (FlRestingParts){0};
    part->disposable = true;
    part->whole = painter->wants_guides ? guides : NULL;
    return true;
}

/* Where the picture before was taken, the engine still is at an older one. */
static bool catch_up(FlPainter *painter, GError **error)
{
    FlReuse *reuse = painter->reuse;
    if (!reuse || !reuse->state)
        return true;
    g_autoptr(GBytes) state = g_steal_pointer(&reuse->state);
    return painter->plan->engine->load(painter->paint, state, error);
}

static bool keep_picture(FlPainter *painter, GError **error)
{
    FlReuse *reuse = painter->reuse;
    if (!reuse)
        return true;
    reuse->n_painted++;
    if (!reuse->cache)
        return true;
    g_auto(FlPaintedLook) look = {0};
    g_autoptr(GBytes) state = painter->plan->engine->save(painter->paint, error);
    if (!state || !fl_painted_look(&painter->result, &look, error))
        return false;
    fl_reuse_keep(reuse, look.region.painted, fl_painted_bytes(&look.region), state);
    return true;
}

/* The engine's guides of the picture: see make_guides(). */
static FlGuides *engine_guides(FlGuides *guides, FlGuides *part)
{
    return part->mask ? part : guides;
}

/* guided: the picture's guides are there; else it may need none. */
static bool run_engine(FlPainter *painter, bool guided, FlGuides *guides, FlGuides *part,
                       GError **error)
{
    const FlEngine *engine = painter->plan->engine;
    FlPaintedRegion *result = &painter->result;
    if (!catch_up(painter, error))
        return false;
    if (!guided && engine->rest(painter->paint))
        return keep_picture(painter, error);
    if ((!guided && !make_guides(painter, guides, part, error)) || !fl_painted_renew(result, error))
        return false;
    const FlEnginePaint paint = {result->painted, result->alpha, &result->stats,
                                 painter->wants_view ? &result->view : NULL};
    return engine->frame(painter->paint, engine_guides(guides, part), &paint, error) &&
           keep_picture(painter, error);
}

/* The region's picture `index`, held ones counted once, into painter->result.painted; k: how many
 * were painted before it. */
static bool paint_picture(FlPainter *painter, int k, int index, FlGuides *guides, GError **error)
{
    FlReuse *reuse = painter->reuse;
    const int last = painter->picture;
    painter->picture = painter->wrap + index;
    painter->result.stats = (FlFrameStats){0};
    painter->result.view = (FlSynthView){0};
    const bool known = is_known(painter), still = !known && rests(painter, last);
    const bool guided = !known && (!still || painter->wants_guides);
    g_auto(FlGuides) part = {0};
    if (guided && !make_guides(painter, guides, &part, error))
        return false;
    if (reuse)
        fl_reuse_next(reuse, k, still ? NULL : engine_guides(guides, &part),
                      painter->plan->style->exemplar->level[0].first);
    if (reuse && reuse->cache && !fl_painted_open(&painter->result, error))
        return false;
    painter->follows = true;
    painter->result.taken =
        reuse && fl_reuse_take(reuse, painter->result.painted, fl_painted_bytes(&painter->result));
    if (painter->result.taken)
        return true;
    if (!known)
        return run_engine(painter, guided, guides, &part, error);
    g_set_error(error, FL_ERROR, FL_ERROR_CHANGED, "region %s: its paint is gone from the cache",
                painter->plan->name);
    return false;
}

bool fl_painter_flow(const FlPainter *painter, float *flow, GError **error)
{
    const FlRect rect = painter->result.rect;
    if (!halves(painter))
        return fl_guide_sequence_flow(painter->guides, painter->picture, flow, error);
    g_autofree float *half = fl_alloc_unset(2 * fl_rect_pixels(guided_rect(painter)), sizeof(float),
                                            "a flow field", error);
    if (!half || !fl_guide_sequence_flow(painter->guides, painter->picture, half, error))
        return false;
    fl_flow_double(half, rect.width, rect.height, flow);
    return true;
}

/* Who looks at guides beside the picture wants them in its size. */
static bool show_guides(const FlPainter *painter, FlGuides *guides, GError **error)
{
    const FlRect rect = painter->result.rect;
    if (!halves(painter) || !painter->wants_guides || !guides->mask)
        return true;
    g_auto(FlGuides) half = *guides;
    *guides = (FlGuides){0};
    return fl_guides_double(&half, rect.width, rect.height, guides, error);
}

bool fl_painter_lead_in(FlPainter *painter, int k, FlGuides *guides, GError **error)
{
    const FlLoop *loop = &painter->loop;
    return painter->result.unseen || k >= loop->n ||
           (paint_picture(painter, k, loop->first + k, guides, error) &&
            fl_loop_keep(&painter->loop, k, &painter->result, error));
}

/* Loads the paint of a frame that another run has painted. */
static bool load_paint(FlPainter *painter, int frame, GError **error)
{
    g_autofree char *file =
        fl_paint_file(painter->plan->paint_files, painter->drawing, painter->plan, frame, error);
    return file && fl_paint_load(&painter->result, file, error);
}

bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    if (painter->result.unseen)
        return true;
    if (painter->plan->paint_files)
        return load_paint(painter, frame, error);
    const int index = frame / painter->plan->settings.hold;
    if (frame % painter->plan->settings.hold != 0)
        return true;
    if (!paint_picture(painter, painter->loop.n + index, index, guides, error) ||
        !fl_loop_blend(&painter->loop, index, &painter->result, error) ||
        !show_guides(painter, guides, error))
        return false;
    painter->result.seconds = (double)(g_get_monotonic_time() - start) * 1e-6;
    return true;
}

/* Whether a frame may show the picture of one before it, so that a resumed render needs it. */
static bool keeps_picture(const FlPainter *painter)
{
    return painter->plan->settings.hold > 1 || fl_drawing_stands_still(painter->drawing);
}

bool fl_painter_save(const FlPainter *painter, GBytes *parts[FL_PAINTER_PARTS], GError **error)
{
    const bool none = painter->plan->paint_files || painter->result.unseen;
    const bool holds = keeps_picture(painter) && !none;
    parts[2] = painter->reuse ? fl_reuse_save(painter->reuse) : g_bytes_new(NULL, 0);
    if (none || is_known(painter))
        parts[0] = g_bytes_new(NULL, 0);
    else if (painter->reuse && painter->reuse->state)
        parts[0] = g_bytes_ref(painter->reuse->state);
    else if (!(parts[0] = painter->plan->engine->save(painter->paint, error)))
        return false;
    g_auto(FlPaintedLook) look = {0};
    if (holds && !fl_painted_look(&painter->result, &look, error))
        return false;
    parts[1] = g_bytes_new(look.region.painted, holds ? fl_painted_bytes(&look.region) : 0);
    return true;
}

/* The state of the engine, or what the cache has in its place. */
static bool load_state(FlPainter *painter, GBytes *const parts[FL_PAINTER_PARTS], GError **error)
{
    FlReuse none = {0}, *reuse = painter->reuse ? painter->reuse : &none;
    if (!fl_reuse_load(reuse, parts[2], parts[0])) {
        g_set_error(
            error, FL_ERROR, FL_ERROR_CHANGED,
            "its paint was taken from the cache, and is gone; use ‘overwrite’ to start anew");
        return false;
    }
    if (is_known(painter))
        return true;
    g_autoptr(GBytes) state = g_steal_pointer(&reuse->state);
    return painter->plan->engine->load(painter->paint, state, error);
}

bool fl_painter_load(FlPainter *painter, GBytes *const parts[FL_PAINTER_PARTS], GError **error)
{
    if (painter->plan->paint_files || painter->result.unseen)
        return true;
    const size_t bytes = keeps_picture(painter) ? fl_painted_bytes(&painter->result) : 0;
    if (g_bytes_get_size(parts[1]) != bytes) {
        g_set_error(error, FL_ERROR, FL_ERROR_CHANGED,
                    "region %s: the picture of an earlier render has another size",
                    painter->plan->name);
        return false;
    }
    if (!load_state(painter, parts, error)) {
        g_prefix_error(error, "region %s: ", painter->plan->name);
        return false;
    }
    painter->picture = NONE;
    painter->follows = true;
    if (bytes > 0 && !fl_painted_open(&painter->result, error))
        return false;
    if (bytes > 0)
        memcpy(painter->result.painted, g_bytes_get_data(parts[1], NULL), bytes);
    return true;
}
