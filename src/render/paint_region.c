#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/page.h"
#include "base/schedule.h"
#include "compose/colourise.h"
#include "job/plan.h"
#include "job/style_cache.h"
#include "keep/sealed.h"
#include "params/config.h"
#include "render/painter.h"
#include <fluidy/paint.h>
#include <math.h>

#define MOST_PX 1e5f // that a pixel moves in a frame

/* A region whose masks a program gives, and the frame that it gets back. */
typedef struct GivenRegion {
    const FlRegionPaint *region;
    FlRegionPlan plan;
    bool configured; // plan.settings are to be cleared
    FlStyleCache *styles;
    FlStore *cache; // NULL: none
    FlMaskStore *masks;
    FlShapes shapes;
    FlPainter painter;
    FlRect page;
    uint8_t *mask, *paint, *layer;
    uint8_t *alpha; // NULL: the paint has no alpha of its own
} GivenRegion;

static bool refuse(GError **error, const char *what)
{
    return fl_fail(error, FL_ERROR_USAGE, "fl_paint_region(): %s", what);
}

static bool stopped(GError **error, const char *call, int frame)
{
    return fl_fail(error, FL_ERROR_INTERRUPTED, "%s() stopped the painting at frame %d", call,
                   frame);
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

/* ---- input from the caller ------------------------------------------------------------------- */

static bool store_masks(GivenRegion *given, GError **error)
{
    const FlRegionPaint *region = given->region;
    given->masks = fl_mask_store_new(1, region->n_frames, region->width, region->height, error);
    for (int f = 0; given->masks && f < region->n_frames; f++) {
        if (!region->mask(region->data, f, given->mask))
            return stopped(error, "mask", f);
        if (!fl_mask_store_put(given->masks, 0, f, given->mask, error))
            return false;
    }
    return given->masks != NULL;
}

/* FlShapes.flow of the given region in data. */
static bool flow_of(void *data, const FlRegionPlan *plan, int frame, float unknown, float *flow,
                    GError **error)
{
    const GivenRegion *given = data;
    const FlRegionPaint *region = given->region;
    const size_t values = 2 * fl_rect_pixels(given->page);
    if (!region->flow(region->data, frame, flow))
        return stopped(error, "flow", frame);
    for (size_t k = 0; k < values; k++) {
        if (isnan(flow[k ^ 1]) || isnan(flow[k]))
            flow[k] = flow[k ^ 1] = unknown;
        else if (!(fabsf(flow[k]) <= MOST_PX))
            return fl_fail(
                error, FL_ERROR_INPUT,
                "flow() of frame %d: %g at x = %zu, y = %zu; expected -100000 to 100000, "
                "or NAN",
                frame, (double)flow[k], k / 2 % (size_t)region->width,
                k / 2 / (size_t)region->width);
    }
    return true;
}

/* ---- before the first frame ------------------------------------------------------------------ */

static bool configure(GivenRegion *given, GError **error)
{
    const FlRegionPaint *region = given->region;
    FlRegionPlan *plan = &given->plan;
    g_autoptr(FlConfig) none = fl_config_load(NULL, NULL, error);
    plan->name = region->name ? region->name : "region";
    if (!none || !fl_config_give(none, region->settings, region->n_settings, error) ||
        !fl_plan_region_settings(none, -1, plan->name, NULL, &plan->settings, error))
        return false;
    given->configured = true;
    for (int k = 0; k < FL_MAPS; k++)
        if (plan->settings.map[k])
            return refuse(error, "control maps are those of a drawing's frames; expected none");
    return plan->settings.style || refuse(error, "‘settings’ have no \"style\"");
}

static bool choose_style(GivenRegion *given, GError **error)
{
    const FlRegionPaint *region = given->region;
    FlRegionPlan *plan = &given->plan;
    FlRegionSettings *settings = &plan->settings;
    const float px =
        settings->params.style_by_page ? fl_page_scale(region->width, region->height) : 1;
    settings->params.half_size = false;
    fl_params_scale_lengths(&settings->params, px);
    given->styles = fl_style_cache_new(true, false);
    plan->style = fl_style_cache_get(given->styles, settings, px, error);
    if (plan->style && fl_field_px(plan->style->exemplar) == 2)
        fl_params_scale_lengths(&settings->params, .5f);
    if (!plan->style)
        return false;
    plan->engine = fl_engine_choose(settings->engine, plan->style->path);
    return fl_plan_choose_fluid(plan, region->flow, error);
}

static bool make_planes(GivenRegion *given, GError **error)
{
    const size_t pixels = fl_rect_pixels(given->page);
    given->mask = fl_alloc(pixels, 1, "a mask", error);
    given->paint = given->mask ? fl_alloc(3 * pixels, 1, "paint", error) : NULL;
    given->layer = given->paint ? fl_alloc(4 * pixels, 1, "a layer", error) : NULL;
    return given->layer != NULL;
}

static bool make_painter(GivenRegion *given, GError **error)
{
    const FlRegionPaint *region = given->region;
    g_autoptr(FlInputs) inputs = fl_inputs_new(NULL, NULL);
    FlPainter *painter = &given->painter;
    const bool hidden = fl_mask_store_extent(given->masks, 0).width == 0;
    if (!fl_sealed_read_key(error))
        return false;
    given->cache =
        fl_store_open(&(FlStoreOptions){.folder = region->cache, .mib = region->cache_size});
    given->shapes = (FlShapes){.n_frames = region->n_frames,
                               .width = region->width,
                               .height = region->height,
                               .seed = MAX(region->seed, 1),
                               .masks = given->masks,
                               .flow = region->flow ? flow_of : NULL,
                               .data = given};
    FlReuse reuse = {0};
    fl_reuse_init(&reuse, given->cache, &given->shapes, &given->plan, inputs);
    fl_painter_init(painter, &given->shapes, &given->plan, reuse);
    fl_painter_place(painter, hidden);
    if (painter->result.reach_px > 0)
        given->alpha = fl_alloc(fl_rect_pixels(given->page), 1, "a layer", error);
    return (given->alpha || !(painter->result.reach_px > 0)) && fl_painter_prepare(painter, error);
}

/* ---- a frame --------------------------------------------------------------------------------- */

/* Paper all over, and the paint where it may be. */
static void fill_paint(GivenRegion *given)
{
    const FlPaintedRegion *painted = &given->painter.result;
    const size_t pixels = fl_rect_pixels(given->page);
    for (size_t p = 0; p < pixels; p++)
        memcpy(given->paint + 3 * p, given->plan.style->paper, 3);
    if (given->alpha)
        memset(given->alpha, 0, pixels);
    if (painted->painted)
        fl_rect_copy(painted->painted, painted->rect, given->paint, given->page, 3);
    if (painted->alpha)
        fl_rect_copy(painted->alpha, painted->rect, given->alpha, given->page, 1);
}

/* The colour of the fill, or the recording's own. */
static FlColouring colouring_of(const GivenRegion *given)
{
    const FlRegionSettings *settings = &given->plan.settings;
    const FlStyleInstance *style = given->plan.style;
    const bool chosen = settings->medium != FL_MEDIUM_AUTO;
    FlColouring colouring = {.tint = settings->has_colour ? FL_TINT_FILL : FL_TINT_KEEP,
                             .medium = chosen ? settings->medium : style->medium};
    if (given->alpha)
        colouring.medium = FL_MEDIUM_SOLID;
    memcpy(colouring.fill, settings->colour, 3);
    memcpy(colouring.paper, style->paper, 3);
    return colouring;
}

static bool colour_layer(GivenRegion *given, GError **error)
{
    const FlRect page = given->page;
    const FlInk *ink = given->plan.style->ink;
    const FlColouring colouring = colouring_of(given);
    const FlPaintedPart part = {given->paint, page, given->alpha};
    const uint8_t *coverage = given->alpha ? given->alpha : given->mask;
    const FlArea area = {.box = page};
    const size_t pixels = fl_rect_pixels(page);
    int exposure = FL_EXPOSURE_ONE;
    if (colouring.tint == FL_TINT_FILL && given->plan.engine->exposure)
        exposure = given->painter.result.exposure;
    else if (colouring.tint == FL_TINT_FILL)
        exposure = fl_ink_exposure(ink, given->paint, given->mask, page.width, page.height);
    g_autofree int16_t *amounts = fl_alloc(pixels, sizeof *amounts, "a layer", error);
    if (!amounts)
        return false;
    memset(given->layer, 0, 4 * pixels);
    fl_colourise_amounts(ink, exposure, &part, coverage, &area, amounts);
    fl_colourise(ink, &colouring, &part, amounts, &area, given->layer);
    for (size_t p = 0; p < pixels && !given->alpha; p++)
        given->layer[4 * p + 3] = (uint8_t)((given->layer[4 * p + 3] * given->mask[p] + 127) / 255);
    return true;
}

static bool do_frame(GivenRegion *given, int frame, GError **error)
{
    const FlRegionPaint *region = given->region;
    const int shown = frame - frame % given->plan.settings.hold;
    const bool painted =
        fl_style_cache_seek(given->styles, frame, region->n_frames, false, error) &&
        fl_painter_frame(&given->painter, frame, error) &&
        fl_mask_store_get(given->masks, 0, shown, given->page, given->mask, error);
    fl_painter_drop_guides(&given->painter);
    if (!painted)
        return false;
    fill_paint(given);
    const FlPaintedFrame out = {frame, region->width, region->height, given->paint, given->layer};
    return colour_layer(given, error) &&
           (region->take(region->data, &out) || stopped(error, "take", frame));
}

/* ---- the whole ------------------------------------------------------------------------------- */

static void clear(GivenRegion *given)
{
    fl_painter_clear(&given->painter);
    fl_store_close(given->cache);
    fl_mask_store_free(given->masks);
    fl_style_cache_free(given->styles);
    if (given->configured)
        fl_region_settings_clear(&given->plan.settings);
    free(given->mask);
    free(given->paint);
    free(given->layer);
    free(given->alpha);
}

static bool paint(GivenRegion *given, GError **error)
{
    if (!configure(given, error) || !choose_style(given, error) || !make_planes(given, error) ||
        !store_masks(given, error) || !make_painter(given, error))
        return false;
    for (int f = 0; f < given->region->n_frames; f++)
        if (!do_frame(given, f, error))
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
    GivenRegion given = {.region = &known, .page = {0, 0, known.width, known.height}};
    if (known.threads > 0)
        (void)fl_schedule_set_threads(known.threads);
    const bool done = paint(&given, error);
    clear(&given);
    (void)fl_schedule_set_threads(threads);
    return done;
}
