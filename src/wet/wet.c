#include "wet/wet.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "guides/distance.h"
#include "guides/guides.h"
#include "params/text.h"
#include "wet/curves.h"
#include "wet/marks.h"
#include <math.h>

#define AHEAD_FRAMES 4   // a front wets paper where the figure will be so soon
#define MARGIN_PX 11     // px of the page around the masks of these frames
#define GROUND_SHARE 0.4 // of the page: a larger region is ground
#define CELL_PX 1.3f     // px of a page of FL_WET_PAGE_PX that a cell may have, about
#define NO_REGION UINT16_MAX

/** A region that marks the paper. */
typedef struct Marker {
    const FlRegionPlan *plan;
    FlWetDials dials; // by its size in the film
    float fill[3];    // absorbance
    FlEdgeBefore before;
    bool rests;
    GArray *fronts, *stains; // of FlFrontMark and FlStainMark: those of the last frame
    float partner;           // share of it that was there a frame before
} Marker;

struct FlWet {
    const FlPlan *plan;
    uint8_t paper[3];
    FlWetMotion motion;
    void *motion_data;
    int cell; // px of the drawing
    FlWetSheet sheet;
    int n_markers;
    Marker *marker;
    bool *ground;             // by region
    int camera;               // the region that the paper moves with; -1: none
    float camera_x, camera_y; // motion of the paper that is less than a cell
    uint16_t *lowest[2];      // of the page: the lowest region in each cell, now and before
    int lowest_frame;         // of lowest[0]
    bool knows_laid;
    FlLaid laid;
    FlStainLayer layer;
    int at; // the last frame; -1: none
};

/* ---- masks in cells ------------------------------------------------------------------------- */

static FlRect px_of(const FlWet *wet, FlRect cells)
{
    const FlDrawing *drawing = wet->plan->drawing;
    const FlRect page = {0, 0, fl_drawing_width(drawing), fl_drawing_height(drawing)};
    const int c = wet->cell;
    return fl_rect_and((FlRect){c * cells.x, c * cells.y, c * cells.width, c * cells.height}, page);
}

static FlRect cells_of(const FlWet *wet, FlRect px)
{
    const int c = wet->cell;
    return fl_rect_between(px.x / c, px.y / c, (px.x + px.width + c - 1) / c,
                           (px.y + px.height + c - 1) / c);
}

/** Means of the px of each cell. */
static bool get_mask(const FlWet *wet, int region, int frame, FlRect rect, uint8_t *mask,
                     GError **error)
{
    const FlRect px = px_of(wet, rect);
    const int c = wet->cell;
    if (c == 1)
        return fl_mask_store_get(wet->plan->masks, region, frame, rect, mask, error);
    g_autofree uint8_t *full = fl_alloc_unset(fl_rect_pixels(px), 1, "a mask", error);
    if (!full || !fl_mask_store_get(wet->plan->masks, region, frame, px, full, error))
        return false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const int right = MIN(c * x + c, px.width), lower = MIN(c * y + c, px.height);
            int sum = 0, n = 0;
            for (int j = c * y; j < lower; j++)
                for (int i = c * x; i < right; i++, n++)
                    sum += full[(size_t)j * (size_t)px.width + (size_t)i];
            mask[(size_t)y * (size_t)rect.width + (size_t)x] = (uint8_t)(sum / MAX(n, 1));
        }
    return true;
}

/** The motion in the middle of each cell, in cells. */
static bool get_motion(const FlWet *wet, const Marker *marker, int before, int now, FlRect rect,
                       float *motion, GError **error)
{
    const FlRect px = px_of(wet, rect);
    const int c = wet->cell;
    g_autofree float *full =
        fl_alloc_unset(2 * fl_rect_pixels(px), sizeof *full, "a motion", error);
    if (!full || !wet->motion(wet->motion_data, marker->plan->region, before, now, px, full, error))
        return false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const int i = MIN(c * x + c / 2, px.width - 1), j = MIN(c * y + c / 2, px.height - 1);
            const float *from = full + 2 * ((size_t)j * (size_t)px.width + (size_t)i);
            float *to = motion + 2 * ((size_t)y * (size_t)rect.width + (size_t)x);
            to[0] = from[0] / (float)c, to[1] = from[1] / (float)c;
        }
    return true;
}

/* ---- constants of the film ------------------------------------------------------------------ */

static double share_of_page(const FlPlan *plan, int region)
{
    const FlRegion *r = fl_drawing_region(plan->drawing, region);
    const double page = (double)fl_drawing_width(plan->drawing) * fl_drawing_height(plan->drawing);
    const double px = plan->half ? r->area_px / 4 : r->area_px;
    return px * r->n_present / MAX(fl_drawing_frames(plan->drawing), 1) / page;
}

static bool is_ground(const FlPlan *plan, int region)
{
    return share_of_page(plan, region) > GROUND_SHARE;
}

static bool wants_marks(const FlPlan *plan, const FlRegionPlan *region)
{
    const FlFrontStyle *style = &region->style->front;
    const bool front = region->settings.front * style->width > 0;
    return (front || region->settings.stain * style->stain > 0) &&
           !fl_plan_hides(plan, region->region);
}

bool fl_wet_wanted(const FlPlan *plan)
{
    bool wanted = false;
    for (int p = 0; p < plan->n_painted; p++)
        wanted = wanted || wants_marks(plan, &plan->painted[p]);
    return wanted && !fl_plan_is_of_paint(plan);
}

/** Half the width of a region where it is widest, the mean of some frames, cells. */
static bool mean_half_width(const FlWet *wet, int region, float *width, GError **error)
{
    enum { LOOKS = 6 };
    const int n = fl_drawing_frames(wet->plan->drawing);
    float sum = 0;
    int found = 0;
    for (int k = 0; k < MIN(LOOKS, n); k++) {
        const int frame = (int)((int64_t)k * (n - 1) / MAX(MIN(LOOKS, n) - 1, 1));
        const FlRect box = fl_mask_store_box(wet->plan->masks, region, frame);
        const FlRect rect = fl_rect_grown(cells_of(wet, box), 2, wet->sheet.page);
        const size_t pixels = fl_rect_pixels(rect);
        if (box.width == 0)
            continue;
        g_autofree uint8_t *mask = fl_alloc_unset(pixels, 1, "a mask", error);
        g_autofree float *distance =
            mask ? fl_alloc_unset(pixels, sizeof *distance, "a distance", error) : NULL;
        if (!distance || !get_mask(wet, region, frame, rect, mask, error) ||
            !fl_distance(mask, rect.width, rect.height, distance, error))
            return false;
        float most = 0;
        for (size_t p = 0; p < pixels; p++)
            most = MAX(most, distance[p]);
        sum += MIN(most, (float)MAX(rect.width, rect.height)), found++;
    }
    *width = found > 0 ? sum / (float)found : 0;
    return true;
}

/** Parts as large as the page, and eyes and buttons, mark nothing. */
static bool size_dials(const FlWet *wet, Marker *marker, GError **error)
{
    const FlRegionPlan *plan = marker->plan;
    float width = 0;
    if (!mean_half_width(wet, plan->region, &width, error))
        return false;
    const float page = FL_WET_PAGE_PX * wet->sheet.px;
    const float dial = (1 - fl_ease(0.22f, 0.40f, (float)share_of_page(wet->plan, plan->region))) *
                       fl_ease(0.008f, 0.030f, width / page);
    const double overrun = wet->plan->options.overrun;
    marker->dials = (FlWetDials){&plan->style->front, dial * (float)plan->settings.front,
                                 dial * (float)plan->settings.stain, (float)overrun};
    return true;
}

/** The mean colour of the first frame with a region, for those of gradients and pictures. */
static bool find_mean(const FlWet *wet, int region, uint8_t rgb[3], GError **error)
{
    const FlDrawing *drawing = wet->plan->drawing;
    const int first = fl_drawing_region(drawing, region)->first_frame;
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, first, error);
    for (int k = 0; draws && k < draws->n; k++)
        if (draws->draw[k].region == region)
            memcpy(rgb, draws->draw[k].rgb, 3);
    return draws;
}

/** The absorbance of a region's colour. */
static bool find_fill(const FlWet *wet, Marker *marker, GError **error)
{
    const FlRegionSettings *settings = &marker->plan->settings;
    const int region = marker->plan->region;
    const char *paint = fl_drawing_region(wet->plan->drawing, region)->paint;
    uint8_t rgb[3] = {128, 128, 128};
    if (settings->has_colour)
        memcpy(rgb, settings->colour, 3);
    else if (!fl_text_colour(paint, rgb) && !find_mean(wet, region, rgb, error))
        return false;
    for (int c = 0; c < 3; c++)
        marker->fill[c] = fl_wet_absorbance(rgb[c], wet->paper[c]);
    return true;
}

static bool make_markers(FlWet *wet, GError **error)
{
    const FlPlan *plan = wet->plan;
    wet->marker = g_new0(Marker, MAX(plan->n_painted, 1));
    for (int p = 0; p < plan->n_painted; p++) {
        Marker *marker = &wet->marker[wet->n_markers];
        *marker = (Marker){.plan = &plan->painted[p]};
        if (!wants_marks(plan, marker->plan))
            continue;
        if (!size_dials(wet, marker, error))
            return false;
        if (marker->dials.front <= 0.001f && marker->dials.stain <= 0.001f)
            continue;
        if (!find_fill(wet, marker, error))
            return false;
        marker->fronts = g_array_new(FALSE, FALSE, sizeof(FlFrontMark));
        marker->stains = g_array_new(FALSE, FALSE, sizeof(FlStainMark));
        wet->n_markers++;
    }
    return true;
}

/** The region that the paper moves with; auto: the largest ground. */
static bool find_camera(const FlPlan *plan, int *camera, GError **error)
{
    const char *wanted = plan->options.camera ? plan->options.camera : "auto";
    const bool none = g_str_equal(wanted, "none"), found = g_str_equal(wanted, "auto");
    double most = GROUND_SHARE;
    *camera = -1;
    for (int r = 0; r < fl_drawing_regions(plan->drawing) && !none; r++) {
        const double share = share_of_page(plan, r);
        const bool named = g_str_equal(wanted, fl_drawing_region(plan->drawing, r)->name);
        if (named || (found && share > most))
            *camera = r, most = share;
    }
    if (*camera >= 0 || none || found)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                "camera “%s”: there is no such region; expected auto, none or the name of one",
                wanted);
    return false;
}

FlWet *fl_wet_new(const FlPlan *plan, const uint8_t paper[3], FlWetMotion motion, void *data,
                  GError **error)
{
    const int width = fl_drawing_width(plan->drawing), height = fl_drawing_height(plan->drawing);
    const float page_px = (float)MAX(width, height) / FL_WET_PAGE_PX;
    const int cell = MAX((int)(page_px / CELL_PX + 0.5f), 1);
    g_autoptr(FlWet) wet = g_new0(FlWet, 1);
    *wet = (FlWet){.plan = plan, .motion = motion, .motion_data = data, .cell = cell, .at = -1};
    memcpy(wet->paper, paper, 3);
    wet->ground = g_new0(bool, MAX(fl_drawing_regions(plan->drawing), 1));
    for (int r = 0; r < fl_drawing_regions(plan->drawing); r++)
        wet->ground[r] = is_ground(plan, r);
    wet->lowest_frame = -1;
    const int columns = (width + cell - 1) / cell, rows = (height + cell - 1) / cell;
    const size_t n = (size_t)columns * (size_t)rows;
    const double fps = plan->options.fps > 0 ? plan->options.fps : 24;
    wet->sheet.page = (FlRect){0, 0, columns, rows};
    wet->sheet.width = width, wet->sheet.height = height;
    wet->sheet.px = page_px / (float)cell;
    wet->sheet.stain_time = (float)(plan->options.stain_time * fps / 24);
    wet->sheet.fibres.seed = fl_key(plan->options.paper_seed, 0x776574);
    if (!find_camera(plan, &wet->camera, error) || !fl_wet_sheet_init(&wet->sheet, error) ||
        !fl_laid_init(&wet->laid, columns, rows, (float)cell, error) ||
        !(wet->lowest[0] = fl_alloc(n, sizeof(uint16_t), "regions", error)) ||
        !(wet->lowest[1] = fl_alloc(n, sizeof(uint16_t), "regions", error)) ||
        !make_markers(wet, error))
        return NULL;
    return g_steal_pointer(&wet);
}

void fl_wet_free(FlWet *wet)
{
    if (!wet)
        return;
    for (int m = 0; wet->marker && m < wet->plan->n_painted; m++) {
        fl_edge_before_clear(&wet->marker[m].before);
        g_clear_pointer(&wet->marker[m].fronts, g_array_unref);
        g_clear_pointer(&wet->marker[m].stains, g_array_unref);
    }
    g_free(wet->marker);
    g_free(wet->ground);
    free(wet->lowest[0]);
    free(wet->lowest[1]);
    free(wet->layer.rgba);
    fl_laid_clear(&wet->laid);
    fl_wet_sheet_clear(&wet->sheet);
    g_free(wet);
}

/* ---- a region in a frame -------------------------------------------------------------------- */

/** A frame of the film as it is shown. */
typedef struct Step {
    FlWet *wet;
    int frame;
    float frames;       // since the step before
    float ground[2];    // motion of the paper, cells
    const FlLaid *laid; // of the step before; NULL: not known
} Step;

/** The frame whose picture a region with a hold shows. */
static int shown_by(const FlRegionPlan *plan, int frame)
{
    return frame - frame % plan->settings.hold;
}

/** The picture before that; -1: none. */
static int before_that(const FlWet *wet, const FlRegionPlan *plan, int frame)
{
    const int hold = plan->settings.hold, n = fl_drawing_frames(wet->plan->drawing);
    if (frame >= hold)
        return frame - hold;
    return wet->plan->options.loop ? (n - 1) / hold * hold : -1;
}

/** Frame `frame` + `ahead`; in a film that is no loop, at most the last one. */
static int frame_ahead(const FlWet *wet, int frame, int ahead)
{
    const int n = fl_drawing_frames(wet->plan->drawing);
    return wet->plan->options.loop ? (frame + ahead) % n : MIN(frame + ahead, n - 1);
}

/** Planes of a region's rectangle. */
typedef struct Planes {
    FlRect rect;
    uint8_t *before, *now, *ahead, *touches;
    float *distance, *distance_before, *beyond, *motion;
} Planes;

static void planes_clear(Planes *planes)
{
    free(planes->before);
    free(planes->now);
    free(planes->ahead);
    free(planes->touches);
    free(planes->distance);
    free(planes->distance_before);
    free(planes->beyond);
    free(planes->motion);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Planes, planes_clear)

static bool planes_init(Planes *planes, FlRect rect, GError **error)
{
    const size_t n = fl_rect_pixels(rect);
    const char *what = "the edge of a region";
    planes->rect = rect;
    return (planes->before = fl_alloc_unset(n, 1, what, error)) &&
           (planes->now = fl_alloc_unset(n, 1, what, error)) &&
           (planes->ahead = fl_alloc_unset(n, 1, what, error)) &&
           (planes->touches = fl_alloc_unset(n, 1, what, error)) &&
           (planes->distance = fl_alloc_unset(n, sizeof(float), what, error)) &&
           (planes->distance_before = fl_alloc_unset(n, sizeof(float), what, error)) &&
           (planes->beyond = fl_alloc_unset(n, sizeof(float), what, error)) &&
           (planes->motion = fl_alloc(2 * n, sizeof(float), what, error));
}

/** Around all masks that a region's marks depend on. */
static FlRect marked_part(const FlWet *wet, const FlRegionPlan *plan, int before, int now)
{
    const FlMaskStore *masks = wet->plan->masks;
    FlRect box = fl_rect_or(fl_mask_store_box(masks, plan->region, before),
                            fl_mask_store_box(masks, plan->region, now));
    for (int a = 1; a <= AHEAD_FRAMES; a++)
        box = fl_rect_or(
            box, fl_mask_store_box(masks, plan->region, shown_by(plan, frame_ahead(wet, now, a))));
    const int margin = (int)ceilf(MARGIN_PX * wet->sheet.px) + 2;
    return fl_rect_grown(cells_of(wet, box), margin, wet->sheet.page);
}

static bool read_ahead(const FlWet *wet, const FlRegionPlan *plan, int now, Planes *planes,
                       GError **error)
{
    const size_t n = fl_rect_pixels(planes->rect);
    int last = now;
    memcpy(planes->ahead, planes->now, n);
    for (int a = 1; a <= AHEAD_FRAMES; a++) {
        const int frame = shown_by(plan, frame_ahead(wet, now, a));
        if (frame == last || fl_mask_store_same(wet->plan->masks, plan->region, frame, last))
            continue;
        if (!get_mask(wet, plan->region, frame, planes->rect, planes->touches, error))
            return false;
        for (size_t p = 0; p < n; p++)
            planes->ahead[p] = MAX(planes->ahead[p], planes->touches[p]);
        last = frame;
    }
    return true;
}

/** Where no other paint lay between a region and the paper: bit 0 now, bit 1 before. */
static void find_touches(const FlWet *wet, int region, Planes *planes)
{
    const FlRect rect = planes->rect;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t cell =
                (size_t)(rect.y + y) * (size_t)wet->sheet.page.width + (size_t)(rect.x + x);
            planes->touches[(size_t)y * (size_t)rect.width + (size_t)x] =
                (uint8_t)((wet->lowest[0][cell] >= region) + 2 * (wet->lowest[1][cell] >= region));
        }
}

static float overlap_of(const Planes *planes)
{
    int64_t both = 0, before = 0, now = 0;
    for (size_t p = 0; p < fl_rect_pixels(planes->rect); p++) {
        before += planes->before[p], now += planes->now[p];
        both += MIN(planes->before[p], planes->now[p]);
    }
    return (float)both / (float)MAX(MIN(before, now), 1);
}

/** The distances in a frame that was not looked at. */
static bool find_first(const FlWet *wet, Marker *marker, int frame, GError **error)
{
    FlEdgeBefore *before = &marker->before;
    const int earlier = before_that(wet, marker->plan, frame);
    const FlRect rect = marked_part(wet, marker->plan, earlier < 0 ? frame : earlier, frame);
    const size_t n = fl_rect_pixels(rect);
    g_autofree uint8_t *mask = fl_alloc_unset(n, 1, "a mask", error);
    before->rect = rect;
    return mask && get_mask(wet, marker->plan->region, frame, rect, mask, error) &&
           (before->distance = fl_alloc_unset(n, sizeof(float), "an edge", error)) &&
           fl_distance(mask, rect.width, rect.height, before->distance, error);
}

/** Steps of the distances of find_beyond(): to a neighbour, and across. */
#define STRAIGHT 0.96f
#define ACROSS 1.36f

static void lower(float *distance, float other)
{
    *distance = MIN(*distance, other);
}

/** One way over the rows. */
static void spread(float *distance, FlRect rect, int way)
{
    const int width = rect.width, n = width * rect.height;
    const int first = way > 0 ? 0 : n - 1;
    for (int k = 0; k < n; k++) {
        const int p = first + way * k, x = p % width;
        const bool left = x > 0, right = x < width - 1, above = k >= width;
        float *at = &distance[p];
        if (*at == 0)
            continue;
        if (way > 0 ? left : right)
            lower(at, at[-way] + STRAIGHT);
        if (above)
            lower(at, at[-way * width] + STRAIGHT);
        if (above && left)
            lower(at, at[-way * width - 1] + ACROSS);
        if (above && right)
            lower(at, at[-way * width + 1] + ACROSS);
    }
}

/** How far each pixel is from the masks ahead, to a twentieth. */
static void find_beyond(Planes *planes)
{
    const size_t n = fl_rect_pixels(planes->rect);
    for (size_t p = 0; p < n; p++)
        planes->beyond[p] = planes->ahead[p] >= FL_INSIDE ? 0 : 1e6f;
    spread(planes->beyond, planes->rect, 1);
    spread(planes->beyond, planes->rect, -1);
}

/** The distances in the frame before, as far as they were found then. */
static bool find_before(const FlWet *wet, Marker *marker, int frame, Planes *planes, GError **error)
{
    const FlRect rect = planes->rect;
    FlEdgeBefore *before = &marker->before;
    for (size_t p = 0; p < fl_rect_pixels(rect); p++)
        planes->distance_before[p] = -MARGIN_PX * wet->sheet.px;
    if (!before->distance && !find_first(wet, marker, frame, error))
        return false;
    fl_rect_copy(before->distance, before->rect, planes->distance_before, rect, sizeof(float));
    return true;
}

static bool read_planes(const Step *step, Marker *marker, int before, int now, bool moves,
                        Planes *planes, GError **error)
{
    const FlWet *wet = step->wet;
    const int region = marker->plan->region;
    const FlRect rect = planes->rect;
    if (!get_mask(wet, region, before, rect, planes->before, error) ||
        !get_mask(wet, region, now, rect, planes->now, error) ||
        !read_ahead(wet, marker->plan, now, planes, error) ||
        !fl_distance(planes->now, rect.width, rect.height, planes->distance, error) ||
        !find_before(wet, marker, before, planes, error))
        return false;
    find_beyond(planes);
    find_touches(wet, region, planes);
    return !moves || !wet->motion ||
           get_motion(wet, marker, before, now, rect, planes->motion, error);
}

static void forget(Marker *marker)
{
    fl_edge_before_clear(&marker->before);
    g_array_set_size(marker->fronts, 0);
    marker->rests = false;
}

/** The share of the shape's contour that is known to have been there, roughly. */
static float partner_of(const Planes *planes, float overlap)
{
    size_t known = 0, all = 0;
    for (size_t p = 0; p < fl_rect_pixels(planes->rect); p++)
        if (planes->now[p] >= FL_INSIDE)
            all++, known += !isnan(planes->motion[2 * p]);
    return MAX((float)known / (float)MAX(all, 1), fl_ease(0.02f, 0.2f, overlap));
}

static bool mark_moving(const Step *step, Marker *marker, int before, int now, bool moves,
                        GError **error)
{
    const FlWet *wet = step->wet;
    g_auto(Planes) planes = {0};
    g_auto(FlMovingEdge) edge = {0};
    if (!planes_init(&planes, marked_part(wet, marker->plan, before, now), error) ||
        !read_planes(step, marker, before, now, moves, &planes, error))
        return false;
    FlWetShape shape = {.rect = planes.rect,
                        .page = wet->sheet.page,
                        .px = wet->sheet.px,
                        .frames = step->frames,
                        .before = planes.before,
                        .now = planes.now,
                        .distance = planes.distance,
                        .distance_before = planes.distance_before,
                        .motion = planes.motion,
                        .ground_x = step->ground[0],
                        .ground_y = step->ground[1],
                        .overlap = overlap_of(&planes),
                        .laid = step->laid,
                        .region = marker->plan->region};
    memcpy(shape.paper, wet->paper, 3);
    memcpy(shape.fill, marker->fill, sizeof shape.fill);
    marker->partner = partner_of(&planes, shape.overlap);
    const FlWetAround around = {planes.beyond, planes.touches};
    if (!fl_moving_edge_init(&edge, &shape, &marker->before, error))
        return false;
    g_array_set_size(marker->fronts, 0);
    fl_marks_add_stain(&shape, &edge, &around, &marker->dials, marker->stains);
    marker->rests = !moves && edge.fastest < 0.02f * wet->sheet.px;
    return fl_edge_before_take(&marker->before, &shape, &edge, error) &&
           (marker->dials.front <= 0 || fl_marks_add_front(&shape, &edge, &around, &marker->dials,
                                                           &wet->sheet, marker->fronts, error));
}

/** The work of fl_schedule_run(). */
static bool mark_one(void *data, int m, int thread, GError **error)
{
    const Step *step = data;
    const FlWet *wet = step->wet;
    Marker *marker = &wet->marker[m];
    const FlRegionPlan *plan = marker->plan;
    const int now = shown_by(plan, step->frame), before = before_that(wet, plan, now);
    g_array_set_size(marker->stains, 0);
    marker->partner = 1;
    if (!fl_mask_store_has(wet->plan->masks, plan->region, now)) {
        forget(marker);
        return true;
    }
    if (before < 0 || !fl_mask_store_has(wet->plan->masks, plan->region, before)) {
        forget(marker);
        marker->partner = before < 0;
        return true;
    }
    if (now != step->frame) // its last picture is shown again, and wets what it wetted
        return true;
    const bool still = fl_mask_store_same(wet->plan->masks, plan->region, before, now) &&
                       step->ground[0] == 0 && step->ground[1] == 0;
    if (still && marker->rests)
        return true;
    return mark_moving(step, marker, before, now, !still, error);
}

/* ---- the frame ------------------------------------------------------------------------------ */

/** The lowest painted region of each cell. */
static bool find_lowest(const FlWet *wet, int frame, uint16_t *lowest, GError **error)
{
    const FlRect page = wet->sheet.page;
    memset(lowest, 0xff, fl_rect_pixels(page) * sizeof *lowest);
    for (int p = wet->plan->n_painted - 1; p >= 0; p--) {
        const int region = wet->plan->painted[p].region;
        const int shown = shown_by(&wet->plan->painted[p], frame);
        const FlRect box = cells_of(wet, fl_mask_store_box(wet->plan->masks, region, shown));
        if (box.width == 0 || wet->ground[region])
            continue;
        g_autofree uint8_t *mask = fl_alloc_unset(fl_rect_pixels(box), 1, "a mask", error);
        if (!mask || !get_mask(wet, region, shown, box, mask, error))
            return false;
        for (int y = 0; y < box.height; y++)
            for (int x = 0; x < box.width; x++) {
                const size_t cell = (size_t)(box.y + y) * (size_t)page.width + (size_t)(box.x + x);
                if (mask[(size_t)y * (size_t)box.width + (size_t)x] >= FL_INSIDE)
                    lowest[cell] = MIN(lowest[cell], (uint16_t)region);
            }
    }
    return true;
}

static bool update_lowest(FlWet *wet, int before, int frame, GError **error)
{
    if (wet->lowest_frame != before && !find_lowest(wet, MAX(before, 0), wet->lowest[0], error))
        return false;
    uint16_t *last = wet->lowest[1];
    wet->lowest[1] = wet->lowest[0], wet->lowest[0] = last;
    wet->lowest_frame = frame;
    return find_lowest(wet, frame, last, error);
}

/** How the paper has moved since the frame before. */
static void follow_camera(const FlWet *wet, int before, int frame, float ground[2])
{
    ground[0] = ground[1] = 0;
    if (wet->camera < 0 || before < 0)
        return;
    const FlAnchor now = fl_drawing_anchor(wet->plan->drawing, wet->camera, frame);
    const FlAnchor was = fl_drawing_anchor(wet->plan->drawing, wet->camera, before);
    ground[0] = (now.x - was.x) / (float)wet->cell, ground[1] = (now.y - was.y) / (float)wet->cell;
}

/** The share of the painted area that was not there before: nearly all of it after a cut. */
static float cut_of(const FlWet *wet, int frame)
{
    double new = 0, all = 0;
    for (int m = 0; m < wet->n_markers; m++) {
        const Marker *marker = &wet->marker[m];
        const int region = marker->plan->region, shown = shown_by(marker->plan, frame);
        if (!fl_mask_store_has(wet->plan->masks, region, shown))
            continue;
        const double area = marker->plan->area_px;
        new += area *(1 - (double)marker->partner), all += area;
    }
    const FlDrawing *drawing = wet->plan->drawing;
    const double page = (double)fl_drawing_width(drawing) * fl_drawing_height(drawing);
    return fl_ease(0.5f, 0.9f, (float)(new / MAX(all, 1))) *
           fl_ease(0.01f, 0.05f, (float)(new / page));
}

static bool mark_all(Step *step, GError **error)
{
    FlWet *wet = step->wet;
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(wet->n_markers, 1));
    for (int m = 0; m < wet->n_markers; m++)
        items[m] = (FlWorkItem){m, wet->marker[m].plan->area_px, false};
    if (!fl_schedule_run(items, wet->n_markers, mark_one, step, error))
        return false;
    const float cut = cut_of(wet, step->frame);
    if (cut > 0)
        fl_wet_sheet_fade(&wet->sheet, 1 - cut);
    for (int m = 0; m < wet->n_markers && cut < 1; m++)
        fl_wet_sheet_stain(&wet->sheet, wet->marker[m].dials.style, wet->marker[m].stains);
    for (int m = 0; m < wet->n_markers; m++)
        fl_wet_sheet_wet(&wet->sheet, step->frames, wet->marker[m].fronts);
    return true;
}

static bool do_step(FlWet *wet, int before, int frame, const FlLaid *laid, GError **error)
{
    Step step = {wet, frame, (float)wet->plan->hold, {0}, laid};
    if (!update_lowest(wet, before, frame, error))
        return false;
    follow_camera(wet, before, frame, step.ground);
    wet->camera_x += step.ground[0], wet->camera_y += step.ground[1];
    const float dx = floorf(wet->camera_x + 0.5f), dy = floorf(wet->camera_y + 0.5f);
    wet->camera_x -= dx, wet->camera_y -= dy;
    if (!fl_wet_sheet_move(&wet->sheet, (int)dx, (int)dy, error))
        return false;
    fl_wet_sheet_dry(&wet->sheet, step.frames);
    return mark_all(&step, error);
}

/** Whether the drawing changes in a frame. */
static bool is_new(const FlWet *wet, int frame)
{
    return frame % wet->plan->hold == 0 && fl_drawing_shown(wet->plan->drawing, frame) == frame;
}

/** The frames before the first that is composed. */
static bool roll_in(FlWet *wet, int frame, GError **error)
{
    const int n = fl_drawing_frames(wet->plan->drawing), hold = wet->plan->hold;
    const int first =
        wet->plan->options.loop ? frame - FL_WET_FRAMES : MAX(frame - FL_WET_FRAMES, 0);
    int before = -1;
    for (int f = first; f < frame; f++) {
        const int at = ((f % n) + n) % n;
        if (!is_new(wet, at))
            continue;
        if (before >= 0 && !do_step(wet, before, at, NULL, error))
            return false;
        before = at;
    }
    (void)hold;
    wet->at = before;
    return true;
}

bool fl_wet_frame(FlWet *wet, int frame, GError **error)
{
    if (wet->at == frame)
        return true;
    const bool first = wet->at < 0;
    if ((first && !roll_in(wet, frame, error)) || (!first && !is_new(wet, frame)))
        return !first;
    g_clear_pointer(&wet->layer.rgba, free);
    if (!do_step(wet, wet->at, frame, first ? NULL : &wet->laid, error))
        return false;
    wet->at = frame;
    if (!fl_wet_sheet_layer(&wet->sheet, wet->paper, &wet->layer, error))
        return false;
    wet->layer.ground = wet->ground;
    return true;
}

const FlStainLayer *fl_wet_layer(const FlWet *wet)
{
    return &wet->layer;
}

FlLaid *fl_wet_laid(FlWet *wet)
{
    return &wet->laid;
}
