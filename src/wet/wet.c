#include "wet/wet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "wet/wet_data.h"
#include <math.h>

#define CELL_PX 2 // px of a page of FL_WET_PAGE_PX that a cell has, about

/** Takes over what follows from masks and sheet alone. */
static void take_from(FlWet *wet, FlWet *before)
{
    if (!before)
        return;
    wet->sheet.grain = g_steal_pointer(&before->sheet.grain);
    wet->half_width = g_steal_pointer(&before->half_width);
    fl_wet_free(before);
}

FlWet *fl_wet_new(const FlShapes *shapes, const FlWetOptions *options, FlWet *before,
                  FlWetMotion motion, void *data, GError **error)
{
    const int width = shapes->width, height = shapes->height;
    const float page_px = (float)MAX(width, height) / FL_WET_PAGE_PX;
    const int cell = MAX((int)(CELL_PX * page_px + 0.5f), 1);
    g_autoptr(FlWet) wet = g_new0(FlWet, 1);
    *wet = (FlWet){.shapes = shapes, .motion = motion, .motion_data = data, .cell = cell};
    memcpy(wet->paper, options->paper, 3);
    wet->overrun = (float)options->overrun;
    take_from(wet, before);
    const int columns = (width + cell - 1) / cell, rows = (height + cell - 1) / cell;
    const size_t n = (size_t)columns * (size_t)rows;
    wet->sheet.page = (FlRect){0, 0, columns, rows};
    wet->sheet.width = width, wet->sheet.height = height, wet->sheet.cell_px = cell;
    wet->sheet.px = page_px / (float)cell;
    wet->sheet.stain_time = (float)options->stain_time;
    wet->sheet.fibres.seed = fl_key(options->seed, 0x776574);
    if (!fl_wet_sheet_init(&wet->sheet, error) ||
        !fl_laid_init(&wet->laid, columns, rows, (float)cell, error) ||
        !(wet->lowest[0] = fl_alloc(n, sizeof(uint16_t), "regions", error)) ||
        !(wet->lowest[1] = fl_alloc(n, sizeof(uint16_t), "regions", error)) ||
        !fl_wet_make_markers(wet, error))
        return NULL;
    wet->ink = g_new(float, 3 * fl_drawing_regions(shapes->drawing) + 1);
    fl_wet_begin(wet, FL_WET_FRAMES);
    return g_steal_pointer(&wet);
}

void fl_wet_begin(FlWet *wet, int known)
{
    wet->known = known;
    wet->at = wet->lowest_frame = -1;
    wet->camera_x = wet->camera_y = 0;
    fl_wet_sheet_begin(&wet->sheet);
    fl_laid_begin(&wet->laid);
    fl_wet_take_fills(wet);
    for (int m = 0; m < wet->n_markers; m++) {
        FlMarker *marker = &wet->marker[m];
        fl_moving_edge_clear(&marker->before);
        g_array_set_size(marker->fronts, 0);
        g_array_set_size(marker->stains, 0);
        marker->rests = false, marker->partner = 0;
    }
}

void fl_wet_free(FlWet *wet)
{
    if (!wet)
        return;
    for (int m = 0; m < wet->n_markers; m++) {
        fl_moving_edge_clear(&wet->marker[m].before);
        g_clear_pointer(&wet->marker[m].fronts, g_array_unref);
        g_clear_pointer(&wet->marker[m].stains, g_array_unref);
    }
    g_free(wet->marker);
    g_free(wet->half_width);
    g_free(wet->ink);
    free(wet->lowest[0]);
    free(wet->lowest[1]);
    free(wet->layer.rgba);
    fl_laid_clear(&wet->laid);
    fl_wet_sheet_clear(&wet->sheet);
    g_free(wet);
}

/* ---- the frame ------------------------------------------------------------------------------ */

/** The lowest figure of each cell. */
static bool find_lowest(const FlWet *wet, int frame, uint16_t *lowest, GError **error)
{
    const FlRect page = wet->sheet.page, px = fl_wet_px_of(wet, page);
    const int c = wet->cell;
    g_autofree uint16_t *full = fl_alloc_unset(fl_rect_pixels(px), sizeof *full, "regions", error);
    if (!full || !fl_surround_lowest(wet->shapes->surround, frame, px, full, error))
        return false;
    for (int y = 0; y < page.height; y++)
        for (int x = 0; x < page.width; x++) {
            const int i = MIN(c * x + c / 2, px.width - 1), j = MIN(c * y + c / 2, px.height - 1);
            lowest[(size_t)y * (size_t)page.width + (size_t)x] =
                full[(size_t)j * (size_t)px.width + (size_t)i];
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

/** The share of the painted area that was not there before: nearly all of it after a cut. */
static float cut_of(const FlWet *wet, int frame)
{
    double fresh = 0, all = 0;
    for (int m = 0; m < wet->n_markers; m++) {
        const FlMarker *marker = &wet->marker[m];
        const int region = marker->plan->region, shown = fl_wet_shown_by(marker->plan, frame);
        if (!fl_mask_store_has(wet->shapes->masks, region, shown))
            continue;
        const double area = marker->plan->area_px;
        fresh += area * (1 - (double)marker->partner), all += area;
    }
    const FlDrawing *drawing = wet->shapes->drawing;
    const double page = (double)fl_drawing_width(drawing) * fl_drawing_height(drawing);
    return fl_ease(0.5f, 0.9f, (float)(fresh / MAX(all, 1))) *
           fl_ease(0.01f, 0.05f, (float)(fresh / page));
}

static bool mark_all(FlWetStep *step, GError **error)
{
    FlWet *wet = step->wet;
    g_autofree FlWorkItem *items = g_new(FlWorkItem, MAX(wet->n_markers, 1));
    for (int m = 0; m < wet->n_markers; m++)
        items[m] = (FlWorkItem){m, wet->marker[m].plan->area_px, false};
    if (!fl_schedule_run(items, wet->n_markers, fl_wet_mark_one, step, error))
        return false;
    const float cut = cut_of(wet, step->frame);
    if (cut > 0)
        fl_wet_sheet_fade(&wet->sheet, 1 - cut);
    for (int m = 0; m < wet->n_markers && cut < 1; m++)
        fl_wet_sheet_take_up(&wet->sheet, wet->marker[m].stains);
    for (int m = 0; m < wet->n_markers && cut < 1; m++)
        fl_wet_sheet_stain(&wet->sheet, wet->marker[m].dials.style, wet->marker[m].stains);
    for (int m = 0; m < wet->n_markers; m++)
        fl_wet_sheet_wet(&wet->sheet, wet->marker[m].dials.style, step->frames,
                         wet->marker[m].fronts);
    return true;
}

/** Shows the cells where the camera has moved them by less than a cell. */
static void place_cells(FlWet *wet)
{
    const float c = (float)wet->cell;
    wet->sheet.shift_x = (int)floorf(c * wet->camera_x + 0.5f);
    wet->sheet.shift_y = (int)floorf(c * wet->camera_y + 0.5f);
}

/** Says if a map of the paper moves it without turning or scaling it. */
static bool only_pans(const FlAffine *map)
{
    return map->xx == 1 && map->yy == 1 && map->xy == 0 && map->yx == 0;
}

/** A camera that pans moves the sheet by whole cells, and shows these where the rest has brought
 * them. */
static bool move_sheet(FlWet *wet, const FlAffine *came, GError **error)
{
    FlAffine from = *came;
    if (only_pans(came)) {
        wet->camera_x -= (float)came->x0, wet->camera_y -= (float)came->y0;
        const float dx = floorf(wet->camera_x + 0.5f), dy = floorf(wet->camera_y + 0.5f);
        wet->camera_x -= dx, wet->camera_y -= dy;
        from.x0 = (double)-dx, from.y0 = (double)-dy;
    } else {
        from.x0 -= wet->camera_x, from.y0 -= wet->camera_y;
        wet->camera_x = wet->camera_y = 0;
    }
    place_cells(wet);
    const bool stays = only_pans(&from) && from.x0 == 0 && from.y0 == 0;
    return stays || fl_wet_sheet_turn(&wet->sheet, &from, error);
}

static bool do_step(FlWet *wet, int before, int frame, bool painted, GError **error)
{
    FlWetStep step = {wet, frame, (float)wet->shapes->hold, false, painted, FL_AFFINE_NONE};
    if (!update_lowest(wet, before, frame, error) ||
        !fl_wet_follow_camera(wet, before, frame, &step.came, error) ||
        !move_sheet(wet, &step.came, error))
        return false;
    step.moved = !only_pans(&step.came) || step.came.x0 != 0 || step.came.y0 != 0;
    fl_wet_sheet_dry(&wet->sheet, step.frames);
    return mark_all(&step, error);
}

/** Says if the drawing changes in a frame. */
static bool is_new(const FlWet *wet, int frame)
{
    return frame % wet->shapes->hold == 0 && fl_drawing_shown(wet->shapes->drawing, frame) == frame;
}

/** The frames before the first that is composed. */
static bool roll_in(FlWet *wet, int frame, GError **error)
{
    const int n = wet->shapes->n_frames;
    const int first = wet->shapes->loop ? frame - wet->known : MAX(frame - wet->known, 0);
    int before = -1;
    for (int f = first; f < frame; f++) {
        const int at = ((f % n) + n) % n;
        if (!is_new(wet, at))
            continue;
        if (before >= 0 && !do_step(wet, before, at, false, error))
            return false;
        before = at;
    }
    wet->at = before;
    return true;
}

/** Makes the layer of the sheet as it is. */
static bool show(FlWet *wet, GError **error)
{
    free(wet->layer.rgba);
    const bool shown = fl_wet_sheet_layer(&wet->sheet, wet->paper, &wet->layer, error);
    wet->layer.ground = wet->shapes->ground;
    return shown;
}

bool fl_wet_frame(FlWet *wet, int frame, GError **error)
{
    if (wet->at == frame)
        return true;
    const bool first = wet->at < 0;
    if ((first && !roll_in(wet, frame, error)) || (!first && !is_new(wet, frame)))
        return !first;
    if (!do_step(wet, wet->at, frame, !first, error))
        return false;
    wet->at = frame;
    return show(wet, error);
}

/** Swaps the contours and the marks of the last frame. */
static void swap_edges(FlMarker *marker, FlMarker *other)
{
    const FlMarker last = *marker;
    marker->before = other->before, other->before = last.before;
    marker->fronts = other->fronts, other->fronts = last.fronts;
    marker->rests = other->rests;
}

bool fl_wet_follow(FlWet *wet, FlWet *earlier, GError **error)
{
    const FlWetSheet sheet = wet->sheet, other = earlier->sheet;
    if (sheet.width != other.width || sheet.height != other.height)
        return true; // a page of another size is a new sheet
    wet->sheet = other, earlier->sheet = sheet;
    wet->camera_x = earlier->camera_x, wet->camera_y = earlier->camera_y;
    place_cells(wet);
    for (int m = 0; m < wet->n_markers; m++)
        for (int k = 0; k < earlier->n_markers; k++)
            if (fl_region_is_same(wet->marker[m].plan, earlier->marker[k].plan))
                swap_edges(&wet->marker[m], &earlier->marker[k]);
    wet->at = 0;
    return show(wet, error);
}

bool fl_wet_begun(const FlWet *wet)
{
    return wet->at >= 0;
}

const FlStainLayer *fl_wet_layer(const FlWet *wet)
{
    return &wet->layer;
}

FlLaid *fl_wet_laid(FlWet *wet)
{
    return &wet->laid;
}
