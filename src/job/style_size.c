#include "job/style_size.h"

#include "base/error.h"
#include "base/limits.h"
#include "config.h"
#include "io/lock.h"
#include "style/write_style.h"
#include "watercolour/simulate.h"

#include <fluidy/render.h>
#include <glib/gstdio.h>
#include <string.h>
#include <unistd.h>

enum { LARGEST = 4 };    // times the size of a recipe
#define MOST_SECONDS 600 // of one core: no recipe of a stranger may take more
#define WAIT_US (G_USEC_PER_SEC / 5)

/* The recipe in a style's folder; may be NULL. */
static char *recipe_of(const FlStyle *style)
{
    if (!style->made_by || strchr(style->made_by, G_DIR_SEPARATOR) ||
        !g_str_has_suffix(style->made_by, ".ini"))
        return NULL;
    g_autofree char *path = g_build_filename(style->path, style->made_by, NULL);
    return g_file_test(path, G_FILE_TEST_IS_REGULAR) ? g_steal_pointer(&path) : NULL;
}

/* The least size that has `factor`, or the largest there may be. */
static int size_for(const FlStyle *style, const FlRecipe *recipe, float factor)
{
    const double millions = (double)style->width * style->height * style->n_frames / 1e6;
    int size = 1;
    while (size < LARGEST && (float)size < factor &&
           fl_limit_check(FL_LIMIT_STYLE, 4 * millions * size * size, style->path, NULL) &&
           fl_recipe_seconds(recipe, 2 * size) < MOST_SECONDS)
        size *= 2;
    return size;
}

/* ---- where it is kept ------------------------------------------------------------------------ */

/* ~/.cache/fluidy-svg/styles/NAME-4x-KEY: whatever decides the pictures is in the key. */
static char *kept_at(const FlStyle *style, const char *recipe_path, int size, GError **error)
{
    g_autofree char *text = NULL, *absolute = g_canonicalize_filename(style->path, NULL);
    gsize bytes = 0;
    GError *problem = NULL;
    if (!g_file_get_contents(recipe_path, &text, &bytes, &problem)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s", problem->message);
        g_error_free(problem);
        return NULL;
    }
    g_autofree char *rest = g_strdup_printf("%s %d %d", FL_VERSION, FL_SIMULATION_VERSION, size);
    g_autoptr(GChecksum) sum = g_checksum_new(G_CHECKSUM_SHA256);
    g_checksum_update(sum, (const guchar *)text, (gssize)bytes);
    g_checksum_update(sum, (const guchar *)rest, -1);
    g_autofree char *base = g_path_get_basename(absolute);
    g_autofree char *name = g_strdup_printf("%s-%dx-%.16s", base, size, g_checksum_get_string(sum));
    return g_build_filename(g_get_user_cache_dir(), "fluidy-svg", "styles", name, NULL);
}

/* style.ini comes last, see fl_style_write(). */
static bool is_kept(const char *folder)
{
    g_autofree char *manifest = g_build_filename(folder, "style.ini", NULL);
    return g_file_test(manifest, G_FILE_TEST_EXISTS);
}

/* ---- making ---------------------------------------------------------------------------------- */

static bool tell(int frame, int n_frames, void *data)
{
    const FlCaller *caller = data;
    const double elapsed_s = fl_seconds_since(caller->start);
    const FlProgress progress = {.stage = "style",
                                 .region_index = -1,
                                 .frame = frame,
                                 .done = frame,
                                 .total = n_frames,
                                 .share = n_frames ? (double)frame / n_frames : 0,
                                 .elapsed_s = elapsed_s,
                                 .frame_s = frame ? elapsed_s / frame : 0,
                                 .remaining_s = -1};
    return !caller->progress || caller->progress(&progress, caller->data);
}

static FlStyle *paint(const FlRecipe *recipe, const char *path, int size, FlCaller caller,
                      GError **error)
{
    fl_note(&caller, "%s: simulating its paint at %d times the size; it is kept for the next time",
            path, size);
    return fl_recipe_paint(recipe, path, size, tell, &caller, error);
}

/* Waits for a lock beside the folder; -1: locks are missing here, or it was interrupted. */
static int wait_for_lock(const char *folder, FlCaller caller)
{
    g_autofree char *parent = g_path_get_dirname(folder);
    g_autofree char *path = g_strconcat(folder, ".lock", NULL);
    if (g_mkdir_with_parents(parent, 0755) != 0)
        return -1;
    for (;;) {
        g_autoptr(GError) held = NULL;
        const int lock = fl_lock_take(path, folder, &held);
        if (lock >= 0 || !held || !tell(0, 0, &caller))
            return lock;
        g_usleep(WAIT_US);
    }
}

static void release_lock(int lock, const char *folder)
{
    g_autofree char *path = g_strconcat(folder, ".lock", NULL);
    if (lock < 0)
        return;
    g_unlink(path); // while still locked: afterwards it may be another process's
    close(lock);
}

/* Paints the style and keeps it if possible. */
static FlStyle *make(const FlRecipe *recipe, const char *path, int size, const char *folder,
                     FlCaller caller, GError **error)
{
    FlStyle *style = paint(recipe, path, size, caller, error);
    g_autoptr(GError) problem = NULL;
    if (style && !fl_style_write(style, folder, true, &problem))
        fl_note(&caller, "%s (the paint is used, but not kept)", problem->message);
    return style;
}

/* The style of a recipe at a size above 1, from the cache or new. */
static FlStyle *larger(const FlRecipe *recipe, const char *path, int size, const char *folder,
                       FlCaller caller, GError **error)
{
    if (is_kept(folder))
        return fl_style_load(folder, error);
    const int lock = wait_for_lock(folder, caller);
    FlStyle *style = is_kept(folder) ? fl_style_load(folder, error)
                                     : make(recipe, path, size, folder, caller, error);
    release_lock(lock, folder);
    return style;
}

FlStyle *fl_style_load_for(const char *folder, float scale, float texture_px, float least_px,
                           bool makes, FlCaller caller, float *factor, GError **error)
{
    g_autoptr(FlStyle) style = fl_style_load(folder, error);
    if (!style)
        return NULL;
    const float given = scale > 0 ? scale : style->scale;
    const float least = least_px / (float)MIN(style->width, style->height);
    *factor = MAX(given * texture_px, MIN(given, least));
    g_autofree char *path = *factor > 1 && makes ? recipe_of(style) : NULL;
    if (!path)
        return g_steal_pointer(&style);
    g_autoptr(FlRecipe) recipe = fl_recipe_load(path, error);
    const int size = recipe ? size_for(style, recipe, *factor) : 0;
    g_autofree char *kept = recipe ? kept_at(style, path, size, error) : NULL;
    if (!kept)
        return NULL;
    if (size == 1)
        return g_steal_pointer(&style);
    g_clear_pointer(&style, fl_style_free); // it is large
    caller.start = g_get_monotonic_time();
    *factor /= (float)size;
    return larger(recipe, path, size, kept, caller, error);
}
