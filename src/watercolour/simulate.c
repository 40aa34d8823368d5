/* The simulation of a recipe: the stages of a step, the steps of a frame, the frames. */
#include <fluidy/watercolour.h>

#include "base/alloc.h"
#include "base/headroom.h"
#include "style/write_style.h"
#include "watercolour/brush.h"
#include "watercolour/dust.h"
#include "watercolour/scan.h"
#include "watercolour/stages.h"

#include <string.h>

/* One step [C97 §4.2]. */
static void step(FlSheet *sheet, const FlRecipe *recipe)
{
    if (recipe->flow.shallow) {
        fl_update_velocities(sheet, &recipe->flow);
        fl_relax_divergence(sheet, &recipe->flow);
        fl_flow_outward(sheet, &recipe->flow);
    }
    fl_move_pigment(sheet);
    fl_diffuse_pigment(sheet, recipe->pigments, &recipe->flow);
    fl_transfer_pigment(sheet, recipe->pigments, &recipe->flow);
    fl_capillary_flow(sheet, &recipe->flow);
    fl_evaporate(sheet, &recipe->flow);
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

static void lay_dust(FlSheet *sheet, FlDustCloud *dust, int frame)
{
    if (frame > 0)
        fl_dust_drift(dust, sheet, frame - 1);
    fl_dust_lay(dust, sheet);
}

/* The style of a recipe, its frames allocated. */
static FlStyle *new_style(const FlRecipe *recipe, const char *recipe_path, GError **error)
{
    const size_t pixels = (size_t)recipe->width * recipe->height * recipe->frames;
    g_autoptr(FlStyle) style = g_new(FlStyle, 1);
    *style = (FlStyle){
        .name = g_strdup(recipe->name),
        .path = g_strdup(recipe_path),
        .author = g_strdup(recipe->author),
        .licence = g_strdup(recipe->licence),
        .made_by = g_path_get_basename(recipe_path),
        .missing_orientations = g_strdup(recipe->missing),
        .width = recipe->width,
        .height = recipe->height,
        .n_frames = recipe->frames,
        .fps = recipe->fps,
        .border_px = recipe->border,
        .scale = recipe->scale,
        .granulation = recipe->granulation,
        .medium = fl_medium_of_word(recipe->medium),
    };
    memcpy(style->paper, recipe->paper.colour, sizeof style->paper);
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

/* Simulates all frames. */
static bool simulate(FlStyle *style, const FlRecipe *recipe, FlWatercolourProgress progress,
                     void *data, GError **error)
{
    const int scale = recipe->oversample;
    g_autoptr(FlSheet) sheet =
        fl_sheet_new(recipe->width * scale, recipe->height * scale, recipe->n_pigments, error);
    g_autoptr(FlBrush) brush = sheet ? fl_brush_new(recipe, error) : NULL;
    g_autoptr(FlScan) scan = brush ? fl_scan_new(recipe->width, recipe->height, error) : NULL;
    if (!scan)
        return false;
    fl_sheet_make_paper(sheet, recipe);
    g_autoptr(FlDustCloud) dust = NULL;
    if (recipe->dust.grains > 0 && !(dust = fl_dust_new(recipe, sheet, error)))
        return false;
    for (int frame = 0; frame < recipe->frames; frame++) {
        if (dust)
            lay_dust(sheet, dust, frame);
        else
            run_to(sheet, brush, recipe, frame);
        if (!fl_scan_draw(scan, sheet, recipe, error))
            return false;
        store_frame(style, frame, scan);
        if (progress)
            progress(frame + 1, recipe->frames, data);
    }
    return true;
}

bool fl_watercolour_simulate(const char *recipe_path, const char *folder, bool overwrite,
                             FlWatercolourProgress progress, void *data, GError **error)
{
    g_autoptr(FlRecipe) recipe =
        fl_headroom_check(error) ? fl_recipe_load(recipe_path, error) : NULL;
    if (!recipe || !fl_style_may_write(folder, overwrite, error))
        return false;
    g_autoptr(FlStyle) style = new_style(recipe, recipe_path, error);
    return style && simulate(style, recipe, progress, data, error) &&
           fl_style_write(style, folder, overwrite, error);
}
