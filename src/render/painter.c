#include "render/painter.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "job/paint_files.h"
#include "render/painter_guides.h"
#include <math.h>
#include <string.h>

#define NONE (-1) // before the first picture, and after those of an earlier render
#define WRAP 24   // pictures of a loop that guides use beyond each end

FlRect fl_painter_crop(FlRect extent, FlRect page, const FlStyleInstance *style)
{
    const int scale = style->enlargement ? 2 : 1;
    const FlRect grown = fl_rect_grown(extent, scale * fl_guided_patches(style, page), page);
    return fl_rect_on_grid(grown, scale * fl_guided_grid(style, page));
}

static FlRect cropped(const FlPainter *painter)
{
    const FlRect extent = fl_mask_store_extent(painter->masks, painter->plan->region);
    const FlRect page = fl_painter_page(painter);
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
    const FlRect rect = fl_painter_guided(painter),
                 page = fl_guided_part(plan->style, fl_painter_page(painter));
    const FlGuideSource source = fl_painter_guide_source(painter);
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
    g_auto(FlPaintedReader) look = {0};
    g_autoptr(GBytes) state = painter->plan->engine->save(painter->paint, error);
    if (!state || !fl_painted_read(&painter->result, &look, error))
        return false;
    fl_reuse_keep(reuse, look.region.painted, fl_painted_bytes(&look.region), state);
    return true;
}

/* The engine's guides of the picture: see fl_painter_make_guides(). */
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
    if ((!guided && !fl_painter_make_guides(painter, guides, part, error)) ||
        !fl_painted_renew(result, error))
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
    const bool known = is_known(painter), still = !known && fl_painter_rests(painter, last);
    const bool guided = !known && (!still || painter->wants_guides);
    g_auto(FlGuides) part = {0};
    if (guided && !fl_painter_make_guides(painter, guides, &part, error))
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
    g_autofree char *file = fl_paint_file_name(painter->plan->paint_files, painter->drawing,
                                               painter->plan, frame, error);
    return file && fl_paint_file_load(&painter->result, file, error);
}

bool fl_painter_frame(FlPainter *painter, int frame, FlGuides *guides, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    if (painter->result.unseen)
        return true;
    const int hold = painter->plan->settings.hold, index = frame / hold;
    painter->result.anchor =
        fl_drawing_anchor(painter->drawing, painter->plan->region, index * hold);
    if (painter->plan->paint_files)
        return load_paint(painter, frame, error);
    if (frame % hold != 0)
        return true;
    if (!paint_picture(painter, painter->loop.n + index, index, guides, error) ||
        !fl_loop_blend(&painter->loop, index, &painter->result, error) ||
        !fl_painter_show_guides(painter, guides, error))
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
    g_auto(FlPaintedReader) look = {0};
    if (holds && !fl_painted_read(&painter->result, &look, error))
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
