/* The simulation of a recipe: the stages of a step, the steps of a frame, the frames. */
#include "watercolour/simulate.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "style/style_folder.h"
#include "style/write_style.h"
#include "watercolour/brush.h"
#include "watercolour/dust.h"
#include "watercolour/fine_sheet.h"
#include "watercolour/scan.h"
#include "watercolour/stages.h"

#include <string.h>

/* One step [C97 §4.2]. */
static void step(FlSheet *sheet, const FlRecipe *recipe)
{
    fl_move_pigment(sheet);
    fl_diffuse_pigment(sheet, recipe->pigments);
    fl_transfer_pigment(sheet, recipe->pigments, &recipe->flow);
    fl_capillary_flow(sheet, &recipe->flow);
}

/* The number of steps before a frame (0 is the first), as of a time-lapse camera that slows down.
 */
static int steps_to(const FlRecipe *recipe, int frame)
{
    if (frame == 0)
        return recipe->warm_up;
    const int last = recipe->frames - 1;
    return recipe->steps[0] +
           (last > 1 ? (recipe->steps[1] - recipe->steps[0]) * (frame - 1) / (last - 1) : 0);
}

static void run_to(FlSheet *sheet, const FlBrush *brush, const FlRecipe *recipe, int frame)
{
    const int n = steps_to(recipe, frame);
    for (int i = 0; i < n; i++) {
        const float before = (float)frame + (float)i / (float)n;
        fl_brush_apply(brush, sheet, before, (float)frame + (float)(i + 1) / (float)n);
        step(sheet, recipe);
    }
}

/* The style of a recipe, its frames allocated. */
static FlStyle *new_style(const FlRecipe *recipe, int size, const char *recipe_path, GError **error)
{
    const int width = size * recipe->width, height = size * recipe->height;
    const size_t pixels = (size_t)width * (size_t)height * (size_t)recipe->frames;
    g_autoptr(FlStyle) style = fl_style_like(recipe->style);
    style->path = g_strdup(recipe_path);
    g_free(style->made_by);
    style->made_by = g_path_get_basename(recipe_path);
    style->width = width, style->height = height, style->n_frames = recipe->frames;
    style->border_px = recipe->style->border_px * (float)size;
    style->scale = recipe->style->scale / (float)size;
    if (!(style->rgb = fl_alloc(pixels, 3, "the frames of a style", error)) ||
        !(style->mask = fl_alloc(pixels, 1, "the masks of a style", error)))
        return NULL;
    return g_steal_pointer(&style);
}

static void store_frame(FlStyle *style, int frame, const FlScan *scan)
{
    const size_t pixels = (size_t)scan->width * scan->height;
    memcpy(style->rgb + frame * pixels * 3, scan->rgb, pixels * 3);
    memcpy(style->mask + frame * pixels, scan->mask, pixels);
}

/* A recipe at work. */
typedef struct Studio {
    const FlRecipe *recipe;
    FlSheet *sheet;
    FlBrush *brush;
    FlDustCloud *dust; // NULL: fluid paint
    FlFineSheet *fine; // NULL: the sheet itself is scanned
    FlScan *scan;
} Studio;

static void studio_clear(Studio *studio)
{
    fl_scan_free(studio->scan);
    fl_fine_sheet_free(studio->fine);
    fl_dust_free(studio->dust);
    fl_brush_free(studio->brush);
    fl_sheet_free(studio->sheet);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Studio, studio_clear)

/* Fine cells along a side of a cell: the fewest of which a px of the frames has a whole number. */
static int fine_ratio(int oversample, int size)
{
    int ratio = 1;
    while (ratio * oversample % size != 0)
        ratio++;
    return ratio;
}

static bool studio_init(Studio *studio, const FlRecipe *recipe, int size, GError **error)
{
    const int cells = recipe->oversample;
    studio->recipe = recipe;
    if (!(studio->sheet = fl_sheet_new(recipe->width * cells, recipe->height * cells,
                                       recipe->n_pigments, error)) ||
        !(studio->brush = fl_brush_new(recipe, error)) ||
        !(studio->scan = fl_scan_new(recipe->width * size, recipe->height * size, error)))
        return false;
    fl_sheet_make_paper(studio->sheet, recipe);
    if (recipe->dust.grains > 0 && !(studio->dust = fl_dust_new(recipe, studio->sheet, error)))
        return false;
    const int ratio = fine_ratio(cells, size);
    return ratio == 1 ||
           (studio->fine = fl_fine_sheet_new(studio->sheet, ratio, recipe->seed, error));
}

/* Paints a frame and gives the sheet to scan. Frames must be painted in order. */
static FlSheet *paint_frame(Studio *studio, int frame)
{
    FlSheet *fine = studio->fine ? fl_fine_sheet(studio->fine) : NULL;
    if (studio->dust) {
        if (frame > 0)
            fl_dust_drift(studio->dust, studio->sheet, frame - 1);
        fl_dust_lay(studio->dust, fine ? fine : studio->sheet);
    } else {
        run_to(studio->sheet, studio->brush, studio->recipe, frame);
        if (fine)
            fl_fine_sheet_follow(studio->fine, studio->sheet);
    }
    return fine ? fine : studio->sheet;
}

static bool simulate(FlStyle *style, const FlRecipe *recipe, int size,
                     FlWatercolourProgress progress, void *data, GError **error)
{
    g_auto(Studio) studio = {0};
    if (!studio_init(&studio, recipe, size, error))
        return false;
    for (int frame = 0; frame < recipe->frames; frame++) {
        if (!fl_scan_draw(studio.scan, paint_frame(&studio, frame), recipe, error))
            return false;
        store_frame(style, frame, studio.scan);
        if (progress && !progress(frame + 1, recipe->frames, data))
            return fl_fail(error, FL_ERROR_INTERRUPTED,
                           "%s: interrupted; run it again to start anew", style->path);
    }
    return true;
}

static double steps_of(const FlRecipe *recipe)
{
    double steps = 0;
    for (int frame = 0; frame < recipe->frames && recipe->dust.grains == 0; frame++)
        steps += steps_to(recipe, frame);
    return steps;
}

/* By steps of all cells and moves of all grains; measured. */
double fl_recipe_seconds(const FlRecipe *recipe, int size)
{
    const double pixels = (double)recipe->width * recipe->height;
    const double steps = steps_of(recipe), grains = (double)recipe->dust.grains * recipe->frames;
    return pixels * recipe->oversample * recipe->oversample * steps * 6e-8 + grains * 6e-7 +
           pixels * size * size * recipe->frames * 6e-7;
}

/* The most that it can take beyond the estimate, seconds of one core: a fibre takes a px some 20
 * ns, and a try to place a grain 50 ns an event. */
static double most_seconds(const FlRecipe *recipe, int size)
{
    enum { TRIES = 1000 }; // to place a grain
    const double pixels = (double)recipe->width * recipe->height, cells = recipe->oversample;
    const double fibres = recipe->paper.fibres * pixels / 100;
    return fl_recipe_seconds(recipe, size) +
           fibres * recipe->paper.fibre_px * cells * cells * cells * 2e-8 +
           (double)recipe->dust.grains * TRIES * recipe->n_events * 5e-8;
}

static bool within_limits(const FlRecipe *recipe, int size, const char *path, GError **error)
{
    const double pixels = (double)recipe->width * recipe->height * recipe->frames;
    return fl_limit_check(FL_LIMIT_STYLE, pixels * size * size / 1e6, path, error) &&
           fl_limit_check(FL_LIMIT_RECIPE, most_seconds(recipe, size), path, error);
}

FlStyle *fl_recipe_paint(const FlRecipe *recipe, const char *path, int size,
                         FlWatercolourProgress progress, void *data, GError **error)
{
    if (!within_limits(recipe, size, path, error))
        return NULL;
    g_autoptr(FlStyle) style = new_style(recipe, size, path, error);
    if (!style || !simulate(style, recipe, size, progress, data, error))
        return NULL;
    style->smoothness = fl_style_smoothness(style);
    return g_steal_pointer(&style);
}

bool fl_watercolour_simulate(const char *recipe_path, const char *folder, int size, bool overwrite,
                             FlWatercolourProgress progress, void *data, GError **error)
{
    g_autoptr(FlRecipe) recipe =
        fl_headroom_check(error) ? fl_recipe_load(recipe_path, error) : NULL;
    if (!recipe || !fl_style_may_write(folder, overwrite, error))
        return false;
    g_autoptr(FlStyle) style = fl_recipe_paint(recipe, recipe_path, size, progress, data, error);
    return style && fl_style_write(style, folder, overwrite, error);
}
