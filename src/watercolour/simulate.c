/* A recipe from beginning to end: the stages of a step, the steps of a frame, the frames. */
#include <fluidy/watercolour.h>

#include "style/picture.h"
#include "watercolour/brush.h"
#include "watercolour/dust.h"
#include "watercolour/scan.h"
#include "watercolour/stages.h"

#include <errno.h>
#include <glib/gstdio.h>

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

/* How many steps lead to frame n (0 is the first), as a time-lapse camera that slows down. */
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

static void crumble(FlSheet *sheet, FlDustCloud *dust, int frame)
{
    if (frame > 0)
        fl_dust_drift(dust, sheet, frame - 1);
    fl_dust_lay(dust, sheet);
}

static bool make_folder(const char *path, GError **error)
{
    if (g_mkdir_with_parents(path, 0777) == 0)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot make the folder: %s", path,
                g_strerror(errno));
    return false;
}

static bool write_manifest(const FlRecipe *recipe, const char *recipe_path, const char *folder,
                           GError **error)
{
    g_autofree char *path = g_build_filename(folder, "style.ini", NULL);
    g_autofree char *made_by = g_path_get_basename(recipe_path);
    g_autoptr(GKeyFile) keys = g_key_file_new();
    const uint8_t *paper = recipe->paper.colour;
    g_autofree char *colour = g_strdup_printf("#%02x%02x%02x", paper[0], paper[1], paper[2]);
    g_key_file_set_string(keys, "style", "name", recipe->name);
    g_key_file_set_string(keys, "style", "author", recipe->author);
    g_key_file_set_string(keys, "style", "licence", recipe->licence);
    g_key_file_set_double(keys, "style", "fps", (double)recipe->fps);
    g_key_file_set_double(keys, "style", "border", (double)recipe->border);
    g_key_file_set_double(keys, "style", "scale", (double)recipe->scale);
    g_key_file_set_string(keys, "style", "medium", recipe->medium);
    g_key_file_set_string(keys, "style", "paper", colour);
    g_key_file_set_string(keys, "style", "made-by", made_by);
    g_key_file_set_string(keys, "style", "missing-orientations", recipe->missing);
    g_autoptr(GError) below = NULL;
    if (g_key_file_save_to_file(keys, path, &below))
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                below->message);
    return false;
}

static bool write_frame(const FlScan *scan, const char *folder, int number, GError **error)
{
    g_autofree char *name = g_strdup_printf("%04d.png", number);
    g_autofree char *frame = g_build_filename(folder, "frames", name, NULL);
    g_autofree char *mask = g_build_filename(folder, "masks", name, NULL);
    return fl_png_write(frame, scan->rgb, scan->width, scan->height, 3, error) &&
           fl_png_write(mask, scan->mask, scan->width, scan->height, 1, error);
}

static bool make_folders(const char *folder, GError **error)
{
    g_autofree char *frames = g_build_filename(folder, "frames", NULL);
    g_autofree char *masks = g_build_filename(folder, "masks", NULL);
    return make_folder(frames, error) && make_folder(masks, error);
}

bool fl_watercolour_simulate(const char *recipe_path, const char *output_folder,
                             FlWatercolourProgress progress, void *data, GError **error)
{
    g_autoptr(FlRecipe) recipe = fl_recipe_load(recipe_path, error);
    if (!recipe)
        return false;
    const int scale = recipe->oversample;
    g_autoptr(FlSheet) sheet =
        fl_sheet_new(recipe->width * scale, recipe->height * scale, recipe->n_pigments, error);
    g_autoptr(FlBrush) brush = sheet ? fl_brush_new(recipe, error) : NULL;
    g_autoptr(FlScan) scan = brush ? fl_scan_new(recipe->width, recipe->height, error) : NULL;
    if (!scan || !make_folders(output_folder, error))
        return false;
    fl_sheet_make_paper(sheet, recipe);
    g_autoptr(FlDustCloud) dust = NULL;
    if (recipe->dust.grains > 0 && !(dust = fl_dust_new(recipe, sheet, error)))
        return false;
    for (int frame = 0; frame < recipe->frames; frame++) {
        if (dust)
            crumble(sheet, dust, frame);
        else
            run_to(sheet, brush, recipe, frame);
        if (!fl_scan_draw(scan, sheet, recipe, error) ||
            !write_frame(scan, output_folder, frame + 1, error))
            return false;
        if (progress)
            progress(frame + 1, recipe->frames, data);
    }
    return write_manifest(recipe, recipe_path, output_folder, error);
}
