/* The marks of one region in one frame. */
#include "wet/wet_data.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/windows.h"
#include "guides/distance.h"
#include <math.h>

#define AHEAD_FRAMES 4 // a front wets paper where the figure will be so soon
#define LIMB_PX 12     // px of the page: half the width of a limb, at most
#define MARGIN_PX 11   // px of the page around the masks of these frames

/** The frame whose picture a region with a hold shows. */
int fl_wet_shown_by(const FlRegionPlan *plan, int frame)
{
    return frame - frame % plan->settings.hold;
}

/** The picture before; -1: this is the first. */
static int before_that(const FlWet *wet, const FlRegionPlan *plan, int frame)
{
    const int hold = plan->settings.hold, n = wet->shapes->n_frames;
    if (frame >= hold)
        return frame - hold;
    return wet->shapes->loop ? (n - 1) / hold * hold : -1;
}

/** Frame `frame` + `ahead`; in a film that is no loop, at most the last one. */
static int frame_ahead(const FlWet *wet, int frame, int ahead)
{
    const int n = wet->shapes->n_frames;
    return wet->shapes->loop ? (frame + ahead) % n : MIN(frame + ahead, n - 1);
}

/** Planes of a region's rectangle, in the memory of `now`, `motion` and the maps. */
typedef struct Planes {
    FlRect rect;
    uint8_t *now, *then, *touches, *touched; // `then`: scratch
    float *motion, *distance_before, *beyond;
    float *front, *stain; // control maps; NULL: none
} Planes;

static void planes_clear(Planes *planes)
{
    free(planes->now);
    free(planes->motion);
    free(planes->front);
    free(planes->stain);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Planes, planes_clear)

static bool planes_init(Planes *planes, FlRect rect, GError **error)
{
    const size_t n = fl_rect_pixels(rect);
    planes->rect = rect;
    if (!(planes->now = fl_alloc_unset(4 * n, 1, "the edge of a region", error)) ||
        !(planes->motion = fl_alloc(4 * n, sizeof(float), "the edge of a region", error)))
        return false;
    planes->then = planes->now + n, planes->touches = planes->now + 2 * n;
    planes->touched = planes->now + 3 * n;
    planes->distance_before = planes->motion + 2 * n, planes->beyond = planes->motion + 3 * n;
    return true;
}

/** Around all masks that a region's marks depend on. */
static FlRect marked_part(const FlWet *wet, const FlRegionPlan *plan, int before, int now)
{
    const FlMaskStore *masks = wet->shapes->masks;
    FlRect box = fl_rect_or(fl_mask_store_box(masks, plan->region, before),
                            fl_mask_store_box(masks, plan->region, now));
    for (int a = 1; a <= AHEAD_FRAMES; a++)
        box = fl_rect_or(box, fl_mask_store_box(masks, plan->region,
                                                fl_wet_shown_by(plan, frame_ahead(wet, now, a))));
    const int margin = (int)ceilf(MARGIN_PX * wet->sheet.px) + 2;
    return fl_rect_on_grid(fl_rect_grown(fl_wet_cells_of(wet, box), margin, wet->sheet.page), 2);
}

/** Finds the distance of each cell to the masks of this frame and of those ahead: adds these to
 * `now`. */
static bool find_beyond(const FlWet *wet, const FlRegionPlan *plan, int now, Planes *planes,
                        GError **error)
{
    const FlRect rect = planes->rect;
    const size_t n = fl_rect_pixels(rect);
    int last = now;
    for (int a = 1; a <= AHEAD_FRAMES; a++) {
        const int frame = fl_wet_shown_by(plan, frame_ahead(wet, now, a));
        if (frame == last || fl_mask_store_same(wet->shapes->masks, plan->region, frame, last))
            continue;
        if (!fl_wet_get_mask(wet, plan->region, frame, rect, planes->then, error))
            return false;
        for (size_t p = 0; p < n; p++)
            planes->now[p] = MAX(planes->now[p], planes->then[p]);
        last = frame;
    }
    if (!fl_distance(planes->now, rect.width, rect.height, planes->beyond, error))
        return false;
    for (size_t p = 0; p < n; p++)
        planes->beyond[p] = MAX(-planes->beyond[p], 0);
    return true;
}

/** No other figure is below a region. */
static int lies_lowest(uint16_t lowest, int region)
{
    return lowest == 0 || lowest > region;
}

/** Finds the cells in which a region lies on bare paper; before, also about a limb's half width
 * below other figures, ever less: a limb that leaves shows no hole in a stain. */
static bool find_touches(const FlWet *wet, int region, Planes *planes, GError **error)
{
    const FlRect rect = planes->rect;
    const int reach = (int)(0.9f * LIMB_PX * wet->sheet.px + 0.5f);
    const char *what = "bare paper";
    g_autofree int16_t *bare = fl_alloc_unset(fl_rect_pixels(rect), sizeof *bare, what, error);
    g_autofree uint32_t *near =
        bare ? fl_alloc_unset(fl_rect_pixels(rect), sizeof *near, what, error) : NULL;
    if (!near)
        return false;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const size_t cell =
                (size_t)(rect.y + y) * (size_t)wet->sheet.page.width + (size_t)(rect.x + x);
            const size_t p = (size_t)y * (size_t)rect.width + (size_t)x;
            planes->touches[p] = (uint8_t)lies_lowest(wet->lowest[0][cell], region);
            bare[p] = (int16_t)lies_lowest(wet->lowest[1][cell], region);
        }
    fl_window_sums(bare, rect, reach, near);
    const float all = (float)((2 * reach + 1) * (2 * reach + 1));
    for (size_t p = 0; p < fl_rect_pixels(rect); p++)
        planes->touched[p] = (uint8_t)(255 * fl_ease(0, 0.3f, (float)near[p] / all) + 0.5f);
    return true;
}

/** The share of the smaller of both shapes that lies in the other. */
static float overlap_of(const Planes *planes)
{
    const size_t n = fl_rect_pixels(planes->rect);
    int both = 0, before = 0, now = 0;
    for (size_t p = 0; p < n; p++) {
        const bool was = planes->distance_before[p] > 0, is = planes->now[p] >= FL_INSIDE;
        before += was, now += is, both += was && is;
    }
    return (float)both / (float)MAX(MIN(before, now), 1);
}

static bool read_planes(const FlWetStep *step, FlMarker *marker, int before, int now, bool moves,
                        Planes *planes, GError **error)
{
    const FlWet *wet = step->wet;
    const int region = marker->plan->region;
    const FlRect rect = planes->rect;
    if (!fl_wet_get_mask(wet, region, now, rect, planes->now, error) ||
        !fl_wet_get_mask(wet, region, before, rect, planes->then, error) ||
        !fl_distance(planes->then, rect.width, rect.height, planes->distance_before, error) ||
        !find_touches(wet, region, planes, error))
        return false;
    return !moves || !wet->motion ||
           fl_wet_get_motion(wet, region, before, now, rect, planes->motion, error);
}

/** A region that is gone takes its fronts along. */
static void forget(const FlWet *wet, FlMarker *marker)
{
    const FlWetShape gone = {.page = wet->sheet.page};
    fl_marks_lose_fronts(&gone, &(FlMovingEdge){0}, marker->fronts, marker->stains);
    fl_moving_edge_clear(&marker->before);
    g_array_set_size(marker->fronts, 0);
    marker->rests = false;
}

/** Makes a map of the page one of the part `rect`. */
static FlAffine within(const FlAffine *map, FlRect rect)
{
    const FlPoint corner = fl_affine_apply(map, (FlPoint){rect.x, rect.y});
    FlAffine own = *map;
    own.x0 = corner.x - rect.x, own.y0 = corner.y - rect.y;
    return own;
}

/** Adds the shares at each cell to a region's dials: planes keep them. */
static bool read_maps(const FlWet *wet, const FlMarker *marker, int frame, Planes *planes,
                      FlWetDials *dials, GError **error)
{
    FlControlMap *const *map = marker->plan->map;
    const FlShapes *shapes = wet->shapes;
    const int number = fl_drawing_number(shapes->drawing, frame);
    const double width = (double)shapes->width / wet->cell;
    const double height = (double)shapes->height / wet->cell;
    const bool made = fl_control_map_make(map[FL_MAP_FRONT], number, planes->rect, width, height,
                                          &planes->front, error) &&
                      fl_control_map_make(map[FL_MAP_STAIN], number, planes->rect, width, height,
                                          &planes->stain, error);
    dials->front_map = planes->front, dials->stain_map = planes->stain;
    return made;
}

static bool mark_moving(const FlWetStep *step, FlMarker *marker, int before, int now, bool moves,
                        GError **error)
{
    const FlWet *wet = step->wet;
    g_auto(Planes) planes = {0};
    g_auto(FlMovingEdge) edge = {0};
    FlWetDials dials = marker->dials;
    if (!planes_init(&planes, marked_part(wet, marker->plan, before, now), error) ||
        !read_planes(step, marker, before, now, moves, &planes, error) ||
        !read_maps(wet, marker, now, &planes, &dials, error))
        return false;
    FlWetShape shape = {.rect = planes.rect,
                        .page = wet->sheet.page,
                        .px = wet->sheet.px,
                        .frames = step->frames,
                        .now = planes.now,
                        .distance_before = planes.distance_before,
                        .motion = planes.motion,
                        .came = within(&step->came, planes.rect),
                        .beside = {wet->camera_x, wet->camera_y},
                        .half_width = wet->half_width[marker->plan->region],
                        .overlap = overlap_of(&planes),
                        .laid = &wet->laid,
                        .ink = step->painted ? NULL : wet->ink + 3 * marker->plan->region,
                        .region = marker->plan->region};
    memcpy(shape.paper, wet->paper, 3);
    const FlWetAround around = {planes.beyond, planes.touches, planes.touched};
    if (!fl_moving_edge_init(&edge, &shape, &marker->before, error))
        return false;
    const float known = (float)edge.known / (float)MAX(edge.n, 1);
    marker->partner = MAX(known, fl_ease(0.02f, 0.2f, shape.overlap));
    fl_marks_lose_fronts(&shape, &edge, marker->fronts, marker->stains);
    g_array_set_size(marker->fronts, 0);
    fl_marks_add_stain(&shape, &edge, &around, &dials, marker->stains, marker->fronts);
    marker->rests = !moves && edge.fastest < 0.02f * wet->sheet.px;
    const bool marked =
        !fl_marks_have_front(&shape, &edge, &dials) ||
        (find_beyond(wet, marker->plan, now, &planes, error) &&
         fl_marks_add_front(&shape, &edge, &around, &dials, &wet->sheet, marker->fronts, error));
    const FlMovingEdge before_edge = marker->before;
    marker->before = edge, edge = before_edge;
    return marked;
}

/** The work of fl_schedule_run(). */
bool fl_wet_mark_one(void *data, int m, int thread, GError **error)
{
    const FlWetStep *step = data;
    const FlWet *wet = step->wet;
    FlMarker *marker = &wet->marker[m];
    const FlRegionPlan *plan = marker->plan;
    const int now = fl_wet_shown_by(plan, step->frame), before = before_that(wet, plan, now);
    g_array_set_size(marker->stains, 0);
    marker->partner = 1;
    fl_wet_turn_dials(wet, marker, now);
    const bool shown = fl_region_share(plan, wet->shapes->drawing, now) > 0 &&
                       fl_mask_store_has(wet->shapes->masks, plan->region, now);
    if (!shown || before < 0 || !fl_mask_store_has(wet->shapes->masks, plan->region, before)) {
        forget(wet, marker);
        marker->partner = !shown || before < 0;
        return true;
    }
    if (now != step->frame) // its last picture is shown again, and wets what it wetted
        return true;
    const bool still =
        fl_mask_store_same(wet->shapes->masks, plan->region, before, now) && !step->moved;
    if (still && marker->rests)
        return true;
    return mark_moving(step, marker, before, now, !still, error);
}
