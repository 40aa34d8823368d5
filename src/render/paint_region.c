/* One region without a drawing: masks come from the caller, and paint goes back. */
#include <fluidy/paint.h>

#include "base/alloc.h"
#include "base/limits.h"
#include "base/page.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "compose/colourise.h"
#include "guides/rim.h"
#include "job/moved_paint.h"
#include "job/plan.h"
#include "render/painter.h"
#include "style/style_guides.h"
#include <math.h>
#include <string.h>

#define MOST_PX 1e5f // that a pixel moves in a frame

typedef struct MaskPainter {
    const FlRegionPaint *region;
    FlRegionSettings settings;
    bool configured; // the settings are to be cleared
    FlStyleCache *styles;
    const FlStyleInstance *style; // borrowed
    const FlStyleInstance *tile;  // likewise; NULL: none moves the paint
    const FlEngine *engine;
    FlRect page, rect; // the frame, and where in it the region ever is, with some room
    FlGuideSequence *sequence;
    FlGuides guides;
    void *state;                   // of the engine
    uint8_t *mask, *paint, *layer; // of the page
    float *flow;                   // of the page; NULL: none is given
    uint8_t *painted;              // of rect, and its alpha
    float reach_px;                // of alpha; 0: there is none
    uint8_t *alpha;                // of the page; NULL: there is none
} MaskPainter;

static bool refuse(GError **error, const char *what)
{
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "fl_paint_region(): %s", what);
    return false;
}

static bool stopped(GError **error, const char *call, int frame)
{
    g_set_error(error, FL_ERROR, FL_ERROR_INTERRUPTED, "%s() stopped the painting at frame %d",
                call, frame);
    return false;
}

/* Fields after `threads` are of later versions: a program may be older than they are. */
#define FIRST_SIZE (offsetof(FlRegionPaint, threads) + sizeof(int))

static bool check(const FlRegionPaint *region, GError **error)
{
    if (region->size < FIRST_SIZE)
        return refuse(error, "‘size’ is too small; expected sizeof(FlRegionPaint)");
    if (region->width < 1 || region->width > 32767 || region->height < 1 || region->height > 32767)
        return refuse(error, "‘width’ and ‘height’: expected 1 to 32767");
    if (region->n_frames < 1 || !region->mask || !region->take)
        return refuse(error, "expected at least one frame, and calls ‘mask’ and ‘take’");
    const double pixels = (double)region->width * region->height;
    return fl_limit_check(FL_LIMIT_FRAME, pixels / 1e6, "fl_paint_region()", error);
}

/* ---- what the caller gives ------------------------------------------------------------------- */

static bool read_mask(MaskPainter *painter, int frame, GError **error)
{
    const FlRegionPaint *region = painter->region;
    return region->mask(region->data, frame, painter->mask) || stopped(error, "mask", frame);
}

static bool mask_of(void *data, int frame, uint8_t *coverage, GError **error)
{
    MaskPainter *painter = data;
    if (!read_mask(painter, frame, error))
        return false;
    fl_rect_copy(painter->mask, painter->page, coverage, painter->rect, 1);
    return true;
}

/* Values that are not known become `unknown`; the first frame has none where it is NAN. */
static bool flow_into(MaskPainter *painter, int frame, float unknown, float *flow, GError **error)
{
    const FlRegionPaint *region = painter->region;
    const size_t values = 2 * fl_rect_pixels(painter->page);
    if (!region->flow(region->data, frame, painter->flow))
        return stopped(error, "flow", frame);
    for (size_t k = 0; k < values; k++) {
        if (isnan(painter->flow[k ^ 1]) || isnan(painter->flow[k]))
            painter->flow[k] = painter->flow[k ^ 1] = unknown;
        else if (!(fabsf(painter->flow[k]) <= MOST_PX)) {
            g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                        "flow() of frame %d: %g at x = %zu, y = %zu; expected -100000 to 100000, "
                        "or NAN",
                        frame, (double)painter->flow[k], k / 2 % (size_t)region->width,
                        k / 2 / (size_t)region->width);
            return false;
        }
    }
    fl_rect_copy(painter->flow, painter->page, flow, painter->rect, 2 * sizeof *flow);
    return true;
}

static bool flow_of(void *data, int frame, float *flow, GError **error)
{
    return flow_into(data, frame, 0, flow, error);
}

static bool motion_of(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                      GError **error)
{
    return flow_into(data, frame, NAN, motion, error);
}

/* ---- before the first frame ------------------------------------------------------------------ */

static const char *name_of(const FlRegionPaint *region)
{
    return region->name ? region->name : "region";
}

static bool configure(MaskPainter *painter, GError **error)
{
    const FlRegionPaint *region = painter->region;
    const FlRenderOptions options = {.settings = region->settings,
                                     .n_settings = region->n_settings};
    FlRegionSettings *settings = &painter->settings;
    g_autoptr(FlConfig) none = fl_config_load(NULL, NULL, error);
    if (!none || !fl_config_region_settings(none, -1, name_of(region), &options, settings, error))
        return false;
    painter->configured = true;
    if (!settings->style)
        return refuse(error, "‘settings’ have no \"style\"");
    if (settings->hold != 1)
        return refuse(error, "‘hold’: expected 1; give each picture that is held once");
    return true;
}

static bool choose_style(MaskPainter *painter, GError **error)
{
    const FlRegionPaint *region = painter->region;
    static const FlRenderOptions nobody; // is told of styles that are made larger
    FlRegionSettings *settings = &painter->settings;
    const float px =
        settings->params.style_by_page ? fl_page_scale(region->width, region->height) : 1;
    settings->params.half_size = false;
    fl_params_scale_lengths(&settings->params, px);
    painter->styles = fl_style_cache_new(&nobody);
    painter->style = fl_style_cache_get(painter->styles, settings, px, error);
    if (!painter->style)
        return false;
    painter->engine =
        fl_engine_of_region(painter->styles, painter->style, settings, px, &painter->tile, error);
    if (painter->engine && painter->engine->reach)
        painter->reach_px = painter->engine->reach(painter->style, &settings->params);
    return painter->engine != NULL;
}

static bool make_planes(MaskPainter *painter, GError **error)
{
    const size_t pixels = fl_rect_pixels(painter->page);
    painter->mask = fl_alloc(pixels, 1, "a mask", error);
    painter->paint = painter->mask ? fl_alloc(3 * pixels, 1, "paint", error) : NULL;
    painter->layer = painter->paint ? fl_alloc(4 * pixels, 1, "a layer", error) : NULL;
    if (painter->layer && painter->region->flow)
        painter->flow = fl_alloc(2 * pixels, sizeof *painter->flow, "a flow field", error);
    if (painter->layer && painter->reach_px > 0)
        painter->alpha = fl_alloc(pixels, 1, "a layer", error);
    return painter->layer && (!painter->region->flow || painter->flow) &&
           (!(painter->reach_px > 0) || painter->alpha);
}

static bool find_extent(MaskPainter *painter, GError **error)
{
    const FlRegionPaint *region = painter->region;
    FlRect extent = {0};
    for (int f = 0; f < region->n_frames; f++) {
        if (!read_mask(painter, f, error))
            return false;
        extent = fl_rect_or(extent, fl_rect_of(painter->mask, region->width, region->height));
    }
    extent = fl_rect_grown(extent, (int)ceilf(painter->reach_px), painter->page);
    painter->rect = fl_painter_crop(extent, painter->page, painter->style);
    return true;
}

static bool open_engine(MaskPainter *painter, GError **error)
{
    const FlRegionPaint *region = painter->region;
    const FlRegionSettings *settings = &painter->settings;
    const FlRect rect = painter->rect;
    const bool carries = settings->motion == FL_MOTION_AUTO;
    const FlGuideSource source = {.width = rect.width,
                                  .height = rect.height,
                                  .n_frames = region->n_frames,
                                  .mask = mask_of,
                                  .flow = region->flow && !carries ? flow_of : NULL,
                                  .motion = region->flow && carries ? motion_of : NULL,
                                  .data = painter};
    const FlGuideParams params = fl_guide_params(&settings->params);
    const FlEngineInput input = {painter->style,
                                 painter->tile,
                                 settings,
                                 {rect.width, rect.height, region->width, region->height},
                                 rect.width,
                                 rect.height,
                                 fl_key(MAX(region->seed, 1), g_str_hash(name_of(region)))};
    painter->painted =
        fl_alloc((painter->alpha ? 4 : 3) * fl_rect_pixels(rect), 1, "a painted region", error);
    return painter->painted && fl_guides_init(&painter->guides, rect.width, rect.height, error) &&
           (painter->sequence = fl_guide_sequence_new(&source, &params, error)) &&
           (painter->state = painter->engine->open(&input, error));
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* The alpha of the painted part, behind its colours. */
static uint8_t *own_alpha(const MaskPainter *painter)
{
    return painter->alpha ? painter->painted + 3 * fl_rect_pixels(painter->rect) : NULL;
}

static bool paint_frame(MaskPainter *painter, int frame, GError **error)
{
    FlGuides *guides = &painter->guides;
    FlFrameStats stats = {0};
    const FlEnginePaint paint = {painter->painted, own_alpha(painter), &stats, NULL};
    if (!fl_style_cache_seek(painter->styles, frame, painter->region->n_frames, false, error) ||
        !fl_guide_sequence_get(painter->sequence, frame, guides, error))
        return false;
    const FlRimShape alone = {.width = guides->width,
                              .height = guides->height,
                              .mask = guides->mask,
                              .distance = guides->distance};
    return (!fl_knows_depth(&painter->settings.params) ||
            fl_rim_depth(&alone, painter->style->exemplar->border_px, guides->depth, error)) &&
           painter->engine->frame(painter->state, guides, &paint, error);
}

/* Paper all over, and the paint where it may be. */
static void fill_paint(MaskPainter *painter)
{
    const size_t pixels = fl_rect_pixels(painter->page);
    for (size_t p = 0; p < pixels; p++)
        memcpy(painter->paint + 3 * p, painter->style->paper, 3);
    fl_rect_copy(painter->painted, painter->rect, painter->paint, painter->page, 3);
    if (painter->alpha) {
        memset(painter->alpha, 0, pixels);
        fl_rect_copy(own_alpha(painter), painter->rect, painter->alpha, painter->page, 1);
    }
}

/* The colour of the fill, or the recording's own. */
static FlColouring colouring_of(const MaskPainter *painter)
{
    const FlRegionSettings *settings = &painter->settings;
    const bool given = settings->medium != FL_MEDIUM_AUTO;
    FlColouring colouring = {.tint = settings->has_colour ? FL_TINT_FILL : FL_TINT_KEEP,
                             .medium = given ? settings->medium : painter->style->medium};
    if (colouring.medium == FL_MEDIUM_AUTO)
        colouring.medium = FL_MEDIUM_OPAQUE; // it is laid over anything
    if (painter->alpha)
        colouring.medium = FL_MEDIUM_SOLID;
    memcpy(colouring.fill, settings->colour, 3);
    memcpy(colouring.paper, painter->style->paper, 3);
    return colouring;
}

static bool colour_layer(MaskPainter *painter, GError **error)
{
    const FlRegionPaint *region = painter->region;
    const FlInk *ink = painter->style->ink;
    const FlColouring colouring = colouring_of(painter);
    const FlPaintedPart part = {painter->paint, painter->page, painter->alpha};
    const uint8_t *coverage = painter->alpha ? painter->alpha : painter->mask;
    const FlArea area = {.box = painter->page};
    const size_t pixels = fl_rect_pixels(painter->page);
    int exposure = FL_EXPOSURE_ONE;
    if (colouring.tint == FL_TINT_FILL && painter->engine->exposure)
        exposure = painter->engine->exposure(painter->style);
    else if (colouring.tint == FL_TINT_FILL)
        exposure =
            fl_ink_exposure(ink, painter->paint, painter->mask, region->width, region->height);
    g_autofree int16_t *amounts = fl_alloc(pixels, sizeof *amounts, "a layer", error);
    if (!amounts)
        return false;
    memset(painter->layer, 0, 4 * pixels);
    fl_colourise_amounts(ink, exposure, &part, coverage, &area, amounts);
    fl_colourise(ink, &colouring, &part, amounts, &area, painter->layer);
    for (size_t p = 0; p < pixels && !painter->alpha; p++)
        painter->layer[4 * p + 3] =
            (uint8_t)((painter->layer[4 * p + 3] * painter->mask[p] + 127) / 255);
    return true;
}

static bool do_frame(MaskPainter *painter, int frame, GError **error)
{
    const FlRegionPaint *region = painter->region;
    if (!paint_frame(painter, frame, error) || !read_mask(painter, frame, error))
        return false;
    fill_paint(painter);
    const FlPaintedFrame painted = {frame, region->width, region->height, painter->paint,
                                    painter->layer};
    return colour_layer(painter, error) &&
           (region->take(region->data, &painted) || stopped(error, "take", frame));
}

/* ---- the whole ------------------------------------------------------------------------------- */

static void clear(MaskPainter *painter)
{
    if (painter->state)
        painter->engine->close(painter->state);
    fl_guide_sequence_free(painter->sequence);
    fl_guides_clear(&painter->guides);
    fl_style_cache_free(painter->styles);
    if (painter->configured)
        fl_region_settings_clear(&painter->settings);
    free(painter->mask);
    free(painter->paint);
    free(painter->layer);
    free(painter->flow);
    free(painter->alpha);
    free(painter->painted);
}

static bool paint(MaskPainter *painter, GError **error)
{
    if (!configure(painter, error) || !choose_style(painter, error) ||
        !make_planes(painter, error) || !find_extent(painter, error) ||
        !open_engine(painter, error))
        return false;
    for (int f = 0; f < painter->region->n_frames; f++)
        if (!do_frame(painter, f, error))
            return false;
    return true;
}

bool fl_paint_region(const FlRegionPaint *region, GError **error)
{
    FlRegionPaint known = {0};
    if (region)
        memcpy(&known, region, MIN(region->size, sizeof known));
    if (!check(&known, error))
        return false;
    const int threads = fl_schedule_threads();
    MaskPainter painter = {.region = &known, .page = {0, 0, known.width, known.height}};
    if (known.threads > 0)
        (void)fl_schedule_set_threads(known.threads);
    const bool done = paint(&painter, error);
    clear(&painter);
    (void)fl_schedule_set_threads(threads);
    return done;
}
