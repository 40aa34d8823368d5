#include "render/painter.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/rng.h"
#include "job/outputs.h"
#include <math.h>
#include <string.h>

#define NONE (-1) // before the first picture, and after those of an earlier render
#define WRAP 24   // pictures of a loop that guides use beyond each end

/* The part of the page that is painted of a region with this extent in all frames: with a margin of
 * the coarsest patches, on the grid of the coarsest level, so that it has the page's pyramid. */
static FlRect crop(FlRect extent, FlRect page, const FlRegionPlan *region)
{
    const int scale = fl_field_px(region->style->exemplar);
    const FlRect grown = fl_rect_grown(extent, scale * fl_guided_patches(region, page), page);
    return fl_rect_on_grid(grown, scale * fl_guided_grid(region, page));
}

static FlRect cropped(const FlPainter *painter)
{
    const FlShapes *shapes = painter->shapes;
    const FlRegionPlan *earlier = fl_painter_earlier(painter);
    FlRect extent = fl_mask_store_extent(shapes->masks, painter->plan->region);
    if (earlier)
        extent = fl_rect_or(extent, fl_mask_store_extent(shapes->earlier->masks, earlier->region));
    const FlRect page = fl_painter_page(painter);
    return crop(fl_rect_grown(extent, (int)ceilf(painter->result.reach_px), page), page,
                painter->plan);
}

/* The picture, and the state of a synthesis: the same picture again, and, of each px of the field,
 * two masks and a match. */
double fl_painter_bytes(const FlPainter *painter)
{
    const double rect = (double)fl_rect_pixels(painter->result.rect);
    const int px = fl_field_px(painter->plan->style->exemplar);
    return (6 + (2 + (double)sizeof(FlMatch)) / (px * px)) * rect;
}

/* A region that no frame shows has no paint, no guides and no room. */
static FlPaintOrigin origin_of(const FlPainter *painter, bool hidden)
{
    const GArray *known = painter->reuse.known;
    if (known ? known->len == 0 : hidden)
        return FL_FROM_NOWHERE;
    if (painter->plan->paint_files)
        return FL_FROM_FILE;
    return known ? FL_FROM_CACHE : FL_FROM_ENGINE;
}

/* Clears all but the guides for the whole film. */
static void forget(FlPainter *painter)
{
    fl_painter_drop_guides(painter);
    if (painter->paint)
        painter->plan->engine->close(painter->paint);
    fl_loop_clear(&painter->loop);
    fl_reuse_clear(&painter->reuse);
    fl_painted_clear(&painter->result);
}

void fl_painter_clear(FlPainter *painter)
{
    forget(painter);
    for (int k = 0; k < FL_KEPT_GUIDES; k++)
        fl_guide_sequence_free(painter->kept[k].sequence);
    *painter = (FlPainter){0};
}

void fl_painter_follow(FlPainter *painter, const FlRegionPlan *region)
{
    painter->own = *region;
    painter->result.more = region->more;
}

void fl_painter_init(FlPainter *painter, const FlShapes *shapes, const FlRegionPlan *region,
                     FlReuse reuse)
{
    FlKeptGuides kept[FL_KEPT_GUIDES];
    forget(painter);
    memcpy(kept, painter->kept, sizeof kept);
    *painter = (FlPainter){.plan = &painter->own,
                           .own = *region,
                           .shapes = shapes,
                           .picture = NONE,
                           .reuse = reuse,
                           .result = {.region = region->region,
                                      .name = region->name,
                                      .settings = &painter->own.settings,
                                      .style = region->style,
                                      .map = painter->own.map,
                                      .share = 1,
                                      .more = region->more,
                                      .width = shapes->width,
                                      .height = shapes->height}};
    memcpy(painter->kept, kept, sizeof kept);
    if (region->engine->exposure)
        painter->result.exposure = region->engine->exposure(region->style);
    if (region->engine->reach)
        painter->result.reach_px = region->engine->reach(region->style, &region->settings.params);
    painter->n_pictures = (shapes->n_frames - 1) / region->settings.hold + 1;
    painter->wrap = region->loops ? MIN(painter->n_pictures, WRAP) : 0;
}

void fl_painter_place(FlPainter *painter, bool hidden)
{
    const FlRect place = painter->plan->place;
    painter->origin = painter->result.from = origin_of(painter, hidden);
    if (painter->origin == FL_FROM_CACHE)
        painter->result.rect = painter->reuse.rect;
    else if (painter->origin != FL_FROM_NOWHERE)
        painter->result.rect = place.width > 0 ? place : cropped(painter);
}

/* Opens the engine, at the first picture. */
static bool open_engine(FlPainter *painter, GError **error)
{
    const FlRegionPlan *plan = painter->plan;
    const FlRect rect = painter->result.rect, page = fl_painter_page(painter);
    const FlEngineInput input = {plan->style,
                                 &plan->settings,
                                 {rect.width, rect.height, page.width, page.height},
                                 fl_key(painter->shapes->seed, g_str_hash(plan->name)),
                                 &painter->shapes->stop};
    if (painter->paint)
        plan->engine->close(painter->paint);
    painter->paint = plan->engine->open(&input, error);
    return painter->paint != NULL;
}

/* All that the guides from a source are made from. */
static FlDigest made_of(const FlPainter *painter, const FlGuideSource *source,
                        const FlGuideParams *params)
{
    const FlRegionSettings *settings = &painter->plan->settings;
    const FlFluidDials dials = fl_fluid_dials(settings);
    const int how[] = {source->width,  source->first,        source->n_frames,      painter->wrap,
                       settings->hold, source->flow != NULL, source->motion != NULL};
    FlDigest digest = {0};
    fl_digest_add(&digest, how, sizeof how);
    fl_digest_add(&digest, &painter->result.rect, sizeof painter->result.rect);
    fl_digest_add(&digest, params, sizeof *params);
    fl_digest_add(&digest, &dials, sizeof dials);
    fl_digest_add(&digest, &settings->wetness, sizeof settings->wetness);
    if (painter->plan->styles) { // its frames
        fl_digest_add_text(&digest, painter->plan->styles->text);
        fl_digest_add(&digest, &painter->plan->style_key, sizeof painter->plan->style_key);
    }
    return digest;
}

/* Makes guides, unless the painter has kept them; kept[0] are the last. alone: where those of the
 * whole film are not kept, they are those of a film of the painter's picture and the next one. */
static bool make_sequence(FlPainter *painter, bool alone, GError **error)
{
    FlGuideSource source = fl_painter_guide_source(painter);
    const FlGuideParams params = fl_guide_params(&painter->plan->settings.params);
    const bool draft = painter->plan->settings.detail == FL_DETAIL_DRAFT;
    const int most = draft ? FL_KEPT_GUIDES : 1; // those of drafts are small
    FlKeptGuides *kept = painter->kept;
    FlDigest digest = made_of(painter, &source, &params);
    int k = 0;
    while (k < most && !fl_digest_is_same(digest, kept[k].made_of))
        k++;
    painter->alone = alone && k == most ? painter->picture : NONE;
    if (painter->alone != NONE) {
        source.first = painter->picture, source.n_frames = MIN(2, source.n_frames - source.first);
        digest = made_of(painter, &source, &params);
    }
    FlKeptGuides guides = kept[MIN(k, most - 1)];
    memmove(kept + 1, kept, (size_t)MIN(k, most - 1) * sizeof *kept);
    if (k == most) {
        fl_guide_sequence_free(guides.sequence);
        guides.sequence = fl_painter_open_fluid(painter, error)
                              ? fl_guide_sequence_new(&source, &params, error)
                              : NULL;
        guides.made_of = guides.sequence ? digest : (FlDigest){0};
        fl_painter_close_fluid(painter);
    }
    kept[0] = guides;
    painter->sequence = guides.sequence;
    return painter->sequence != NULL;
}

bool fl_painter_prepare(FlPainter *painter, GError **error)
{
    if (painter->origin == FL_FROM_NOWHERE)
        return true;
    if (painter->plan->loops && !fl_loop_init(&painter->loop, painter->n_pictures, error))
        return false;
    if (painter->origin != FL_FROM_ENGINE)
        return true;
    fl_reuse_begin(&painter->reuse, painter->result.rect);
    return (painter->reuse.drafts || make_sequence(painter, false, error)) &&
           open_engine(painter, error);
}

/* ---- a picture ------------------------------------------------------------------------------- */

/* Brings the engine to the picture before, if that was taken from the cache. */
static bool catch_up(FlPainter *painter, GError **error)
{
    FlReuse *reuse = &painter->reuse;
    g_autoptr(GBytes) state = g_steal_pointer(&reuse->state);
    if (!state || painter->plan->engine->load(painter->paint, state, error))
        return true;
    if (reuse->cache)
        fl_reuse_refuse_state(reuse);
    return false;
}

static bool keep_picture(FlPainter *painter, GError **error)
{
    FlReuse *reuse = &painter->reuse;
    reuse->n_painted++;
    if (!reuse->cache)
        return true;
    const FlPaintedRegion *result = &painter->result;
    g_autoptr(GBytes) state = painter->plan->engine->save(painter->paint, error);
    if (state)
        fl_reuse_keep(reuse, result->painted, fl_painted_bytes(result), state);
    return state;
}

static bool run_engine(FlPainter *painter, GError **error)
{
    const FlEngine *engine = painter->plan->engine;
    FlPaintedRegion *result = &painter->result;
    const bool rests = result->from == FL_FROM_REST && !painter->wants_guides;
    if (!catch_up(painter, error))
        return false;
    if (rests && engine->rest(painter->paint))
        return keep_picture(painter, error);
    if ((rests && !fl_painter_make_guides(painter, error)) || !fl_painted_open(result, error))
        return false;
    result->from = FL_FROM_ENGINE;
    const FlEnginePaint paint = {result->painted, result->alpha, &result->stats,
                                 painter->wants_view ? &result->view : NULL};
    return engine->frame(painter->paint, &painter->guides, &paint, error) &&
           keep_picture(painter, error);
}

/* A draft begins with guides of its picture, which are made quickly, and those of the film follow
 * with another picture. */
static bool guide_draft(FlPainter *painter, GError **error)
{
    const bool guided =
        painter->sequence && (painter->alone == NONE || painter->alone == painter->picture);
    return guided || make_sequence(painter, !painter->sequence, error);
}

/* Chooses the origin of picture k, which follows `last`, and makes its guides if it needs any. */
static bool choose_origin(FlPainter *painter, int k, int last, GError **error)
{
    FlPaintedRegion *result = &painter->result;
    result->from = fl_reuse_has(&painter->reuse, k) ? FL_FROM_CACHE : painter->origin;
    if (result->from == FL_FROM_ENGINE && !guide_draft(painter, error))
        return false;
    if (result->from == FL_FROM_ENGINE && fl_painter_rests(painter, last))
        result->from = FL_FROM_REST;
    const bool guided =
        result->from == FL_FROM_ENGINE || (result->from == FL_FROM_REST && painter->wants_guides);
    return !guided || fl_painter_make_guides(painter, error);
}

/* Takes the picture from the cache, if the cache has it. k: its index in painting order. */
static bool take_picture(FlPainter *painter, int k, GError **error)
{
    FlPaintedRegion *result = &painter->result;
    FlReuse *reuse = &painter->reuse;
    const FlGuides *guides = result->from == FL_FROM_ENGINE ? &painter->guides : NULL;
    fl_reuse_next(reuse, k, guides, painter->plan->style->exemplar->level[0].first);
    if (!reuse->cache)
        return true;
    if (!fl_painted_open(result, error))
        return false;
    if (fl_reuse_take(reuse, result->painted, fl_painted_bytes(result)))
        result->from = FL_FROM_CACHE;
    else if (result->from == FL_FROM_CACHE)
        return fl_fail(error, FL_ERROR_CHANGED, "region %s: its paint is gone from the cache",
                       painter->plan->name);
    return true;
}

/* The region's picture `index`, held ones counted once, into painter->result.painted; k: its index
 * in painting order. */
static bool paint_picture(FlPainter *painter, int k, int index, GError **error)
{
    const int last = painter->picture;
    painter->picture = painter->wrap + index;
    painter->result.stats = (FlFrameStats){0};
    painter->result.view = (FlSynthView){0};
    fl_painter_drop_guides(painter);
    const bool ready = choose_origin(painter, k, last, error) && take_picture(painter, k, error);
    painter->follows = true;
    const bool painted =
        ready && (painter->result.from == FL_FROM_CACHE || run_engine(painter, error));
    painter->next = painted ? k + 1 : NONE;
    painter->picture = painted ? painter->picture : NONE;
    return painted;
}

/* Sets what is keyed to its values in a frame; without a drawing, frames are counted from 1. */
static void move_settings(FlPainter *painter, int frame)
{
    const FlDrawing *drawing = painter->shapes->drawing;
    fl_region_settings_move(&painter->own.settings,
                            drawing ? fl_drawing_number(drawing, frame) : frame + 1);
    painter->result.share = fl_region_share(painter->plan, drawing, frame);
}

bool fl_painter_lead_in(FlPainter *painter, int k, GError **error)
{
    const FlLoop *loop = &painter->loop;
    move_settings(painter, (loop->first + k) * painter->plan->settings.hold);
    return painter->origin == FL_FROM_NOWHERE || k >= loop->n ||
           (paint_picture(painter, k, loop->first + k, error) &&
            fl_loop_keep(&painter->loop, k, &painter->result, error));
}

/* Loads the paint of a frame that another run has painted. */
static bool load_paint(FlPainter *painter, int frame, GError **error)
{
    if (frame < painter->next)
        return true;
    painter->next = frame + 1;
    g_autofree char *file = fl_paint_file_name(painter->plan->paint_files, painter->shapes->drawing,
                                               painter->plan, frame, error);
    return file && fl_paint_file_load(&painter->result, file, error);
}

bool fl_painter_frame(FlPainter *painter, int frame, GError **error)
{
    const gint64 start = g_get_monotonic_time();
    const FlDrawing *drawing = painter->shapes->drawing;
    const int hold = painter->plan->settings.hold, index = frame / hold;
    if (painter->origin == FL_FROM_NOWHERE)
        return true;
    move_settings(painter, index * hold);
    if (drawing) {
        const int region = painter->plan->region;
        painter->result.anchor = fl_drawing_anchor(drawing, region, index * hold);
        painter->result.drift = fl_drawing_drift(drawing, region, painter->shapes->camera,
                                                 index * hold, painter->shapes->loop);
        painter->result.n_limbs =
            fl_drawing_limbs(drawing, region, index * hold, painter->result.limb);
    }
    if (painter->origin == FL_FROM_FILE)
        return load_paint(painter, frame, error);
    const int k = painter->loop.n + index;
    if (frame % hold != 0 || k < painter->next)
        return true;
    if (!paint_picture(painter, k, index, error) ||
        !fl_loop_blend(&painter->loop, index, &painter->result, error))
        return false;
    painter->result.seconds = fl_seconds_since(start);
    return true;
}

/* Before the first picture, or that of the lead-in. An engine that has painted is opened anew. */
static bool restart(FlPainter *painter, GError **error)
{
    const bool fresh = painter->paint && !painter->follows && painter->picture == NONE;
    painter->next = 0, painter->picture = NONE;
    painter->follows = false;
    g_clear_pointer(&painter->reuse.state, g_bytes_unref);
    return fresh || open_engine(painter, error);
}

/* True if the painter's picture is the frame's. One that was stopped on its way may be about to
 * paint the next picture, and still have an earlier one. */
static bool shows(const FlPainter *painter, int frame)
{
    const int index = frame / painter->plan->settings.hold;
    return painter->picture == painter->wrap + index &&
           painter->next == painter->loop.n + index + 1;
}

int fl_painter_seek(FlPainter *painter, int frame, GError **error)
{
    const int hold = painter->plan->settings.hold, lead_in = painter->loop.n;
    const bool files = painter->origin == FL_FROM_FILE;
    const int k = files ? frame : lead_in + frame / hold;
    int from = k;
    if (painter->origin == FL_FROM_NOWHERE || shows(painter, frame))
        return frame;
    while (!files && from > 0 && from != painter->next && !fl_reuse_has(&painter->reuse, from))
        from--;
    const bool starts = !files && from != painter->next && !fl_reuse_has(&painter->reuse, from);
    if (starts && !restart(painter, error))
        return -2;
    painter->next = from;
    return files ? frame : from < lead_in ? -1 : (from - lead_in) * hold;
}

int fl_painter_start_at(FlPainter *painter, int frame, GError **error)
{
    const int hold = painter->plan->settings.hold, k = frame / hold;
    FlReuse *reuse = &painter->reuse;
    if (painter->origin != FL_FROM_ENGINE || painter->plan->loops || shows(painter, frame))
        return fl_painter_seek(painter, frame, error);
    const bool known = painter->next == k || fl_reuse_has(reuse, k);
    if (!known && k > 0 && fl_reuse_has(reuse, k - 1))
        painter->next = k - 1;
    else if (known || restart(painter, error))
        painter->next = k;
    else
        return -2;
    return painter->next * hold;
}
