#include "job/style_cache.h"

#include "base/error.h"
#include "base/limits.h"
#include "config.h"
#include "io/atomic_file.h"
#include "job/engine.h"
#include "style/adapt.h"
#include "style/write_style.h"
#include "synth/enlargement.h"
#include "watercolour/simulate.h"
#include <fluidy/render.h>
#include <glib/gstdio.h>
#include <string.h>
#include <unistd.h>

#define LEAST_STILL 96                  // px: LazyFluids weaves too few patches into a hash
#define BYTES_OF_WINDOW 50.0            // of a pixel, measured: with rotations
#define BYTES_OF_REST 9.0               // while it is loaded
#define WINDOW_BYTES (1024.0 * 1048576) // of one style
#define UNUSED_BYTES (32.0 * 1048576)   // of styles that the plan no longer uses

struct FlStyleCache {
    FlCaller caller;
    int n_callers;
    bool makes, exact;    // see fl_style_cache_new()
    GPtrArray *instances; // of FlStyleInstance
};

static void style_instance_free(FlStyleInstance *instance)
{
    g_free(instance->path);
    fl_exemplar_free(instance->exemplar);
    fl_ink_free(instance->ink);
    fl_tile_free(instance->tile);
    g_free(instance);
}
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlStyleInstance, style_instance_free)

FlStyleCache *fl_style_cache_new(bool makes, bool exact)
{
    FlStyleCache *cache = g_new0(FlStyleCache, 1);
    cache->makes = makes, cache->exact = exact;
    cache->instances = g_ptr_array_new_with_free_func((GDestroyNotify)style_instance_free);
    return cache;
}

void fl_style_cache_set_caller(FlStyleCache *cache, const FlCaller *caller)
{
    cache->caller = *caller;
    cache->n_callers++;
}

void fl_style_cache_free(FlStyleCache *cache)
{
    if (!cache)
        return;
    g_ptr_array_unref(cache->instances);
    g_free(cache);
}

/* Parameters of the search and of the display, on which the reading of recordings does not depend.
 */
static bool is_of_search(const char *name)
{
    static const char *const names[] = {"patchmatch-iterations",
                                        "opt-iterations",
                                        "next-iterations",
                                        "first-rounds",
                                        "finest-rounds",
                                        "finest-sweeps",
                                        "temp-lower",
                                        "temp-upper",
                                        "carry",
                                        "uni-radius",
                                        "settled",
                                        "vote-sharpness",
                                        "boil",
                                        "rest",
                                        "motion-blur",
                                        NULL};
    return g_str_has_prefix(name, "w-") || g_strv_contains(names, name);
}

static bool same_params(const FlParams *a, const FlParams *b)
{
    bool same = true;
    for (int i = 0; i < fl_option_count() && same; i++) {
        const FlOption *option = fl_option_at(i);
        const size_t at = option->offset - offsetof(FlRegionSettings, params);
        same = !option->preset || is_of_search(option->name) ||
               memcmp((const char *)a + at, (const char *)b + at, option->size) == 0;
    }
    return same;
}

/* The frames of a recording in memory: fewer than the parameters allow if it is large; 0: all. */
static int window_of(const FlParams *params, const FlStyle *style)
{
    const double frame = (double)style->width * style->height * BYTES_OF_WINDOW;
    const int most = MAX(1, (int)(WINDOW_BYTES / frame));
    return params->style_window > 0 ? MIN(params->style_window, most) : 0;
}

/* True if a region's field has half the size of its picture. The papers' presets and exports to
 * ebsynth are as they say. */
static bool enlarges(const FlStyleCache *cache, const FlRegionSettings *settings, const char *path)
{
    const FlParams *params = &settings->params;
    return params->half_field && fl_knows_depth(params) && !cache->exact &&
           fl_engine_choose(settings->engine, path)->enlarges;
}

static FlStyleInstance *load(const FlStyleCache *cache, const char *path,
                             const FlRegionSettings *settings, float texture_px, GError **error)
{
    const FlParams *params = &settings->params;
    float factor = 1;
    const bool lazy = settings->engine == FL_ENGINE_LAZYFLUIDS && params->style_by_page;
    g_autoptr(FlStyle) whole =
        fl_style_load_for(path, params->style_scale, texture_px, lazy ? LEAST_STILL : 0,
                          cache->makes, cache->caller, &factor, error);
    const FlStyleUse use = {params->style_start, params->style_frames, params->style_step, factor,
                            settings->reverse};
    const FlStop stop = {cache->caller.stopped, cache->caller.data};
    g_autoptr(FlStyle) style =
        whole && !fl_stop_asked(&stop, error) ? fl_style_adapt(whole, &use, error) : NULL;
    if (!style || fl_stop_asked(&stop, error))
        return NULL;
    g_clear_pointer(&whole, fl_style_free); // it is large
    g_autoptr(FlStyleInstance) instance = g_new0(FlStyleInstance, 1);
    *instance = (FlStyleInstance){.path = g_strdup(path),
                                  .params = *params,
                                  .reverse = settings->reverse,
                                  .halved = enlarges(cache, settings, path),
                                  .enlarged = factor,
                                  .medium = style->medium,
                                  .marks = style->marks,
                                  .granulation = style->granulation,
                                  .fluid = style->fluid,
                                  .front = style->front,
                                  .wash = style->wash,
                                  .sheet = style->sheet};
    memcpy(instance->paper, style->paper, sizeof instance->paper);
    FlParams packed = *params;
    packed.style_window = window_of(params, style);
    if (!(instance->ink = fl_ink_of_style(style, error)) ||
        !(instance->exemplar =
              (instance->halved ? fl_exemplar_new_half : fl_exemplar_new)(style, &packed, error)))
        return NULL;
    instance->border_px = instance->exemplar->border_px * (float)fl_field_px(instance->exemplar);
    return g_steal_pointer(&instance);
}

const FlStyleInstance *fl_style_cache_get(FlStyleCache *cache, const FlRegionSettings *settings,
                                          float texture_px, GError **error)
{
    g_autofree char *path = fl_style_find(settings->style, error);
    if (!path)
        return NULL;
    const FlEngine *engine = fl_engine_choose(settings->engine, path);
    FlStyleInstance *instance = NULL;
    for (guint i = 0; i < cache->instances->len && !instance; i++) {
        const FlStyleInstance *known = cache->instances->pdata[i];
        if (g_str_equal(known->path, path) && known->reverse == settings->reverse &&
            known->halved == enlarges(cache, settings, path) &&
            same_params(&known->params, &settings->params))
            instance = g_ptr_array_steal_index(cache->instances, i);
    }
    if (!instance)
        instance = load(cache, path, settings, texture_px, error);
    if (!instance)
        return NULL;
    instance->caller = cache->n_callers;
    g_ptr_array_add(cache->instances, instance);
    if (engine->needs_tile && !instance->tile &&
        !(instance->tile = fl_tile_load(path, instance->enlarged, error)))
        return NULL;
    return instance;
}

static double bytes_of(const FlStyleInstance *instance)
{
    const FlExemplarLevel *full = &instance->exemplar->level[0];
    const double bytes =
        (double)full->width * full->height *
        (BYTES_OF_WINDOW * full->window + BYTES_OF_REST * (full->n_frames - full->window));
    const FlEnlargement *enlargement = instance->exemplar->enlargement;
    return bytes + (enlargement ? fl_enlargement_bytes(enlargement) : 0);
}

void fl_style_cache_trim(FlStyleCache *cache)
{
    double bytes = 0;
    for (guint i = cache->instances->len; i-- > 0;) {
        const FlStyleInstance *instance = cache->instances->pdata[i];
        if (instance->caller == cache->n_callers)
            continue;
        bytes += bytes_of(instance);
        if (bytes > UNUSED_BYTES)
            g_ptr_array_remove_index(cache->instances, i);
    }
}

double fl_style_cache_bytes(const FlStyleCache *cache)
{
    double bytes = 0;
    for (guint i = 0; i < cache->instances->len; i++)
        bytes += bytes_of(cache->instances->pdata[i]);
    return bytes;
}

/*
 * The window moves with the film, by at most a frame of the recording per frame, to the end of the
 * recording or, in a loop, there and back. It is a function of the frame alone, so that regions can
 * share it and a resumed render has the same.
 */
static int window_at(int spare, int frame, int n_frames, bool loops)
{
    if (loops)
        return (int)((int64_t)2 * MIN(spare, n_frames / 2) * MIN(frame, n_frames - frame) /
                     n_frames);
    return n_frames > 1 ? (int)((int64_t)MIN(spare, n_frames - 1) * frame / (n_frames - 1)) : 0;
}

bool fl_style_cache_seek(FlStyleCache *cache, int frame, int n_frames, bool loops, GError **error)
{
    for (guint i = 0; i < cache->instances->len; i++) {
        const FlStyleInstance *instance = cache->instances->pdata[i];
        FlExemplar *exemplar = instance->exemplar;
        const FlExemplarLevel *full = &exemplar->level[0];
        const int first = window_at(full->n_frames - full->window, frame, n_frames, loops);
        if (!fl_exemplar_seek(exemplar, first, error))
            return false;
    }
    return true;
}

/* ---- sizes of styles ------------------------------------------------------------------------- */

enum { LARGEST = 4 };    // times the size of a recipe
#define MOST_SECONDS 600 // CPU seconds, at most, for a recipe
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
        fl_fail(error, FL_ERROR_INPUT, "%s", problem->message);
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
    const FlStop stop = {caller.stopped, caller.data};
    if (is_kept(folder))
        return fl_style_load_until(folder, &stop, error);
    const int lock = wait_for_lock(folder, caller);
    FlStyle *style = is_kept(folder) ? fl_style_load_until(folder, &stop, error)
                                     : make(recipe, path, size, folder, caller, error);
    release_lock(lock, folder);
    return style;
}

FlStyle *fl_style_load_for(const char *folder, float scale, float texture_px, float least_px,
                           bool makes, FlCaller caller, float *factor, GError **error)
{
    const FlStop stop = {caller.stopped, caller.data};
    g_autoptr(FlStyle) style = fl_style_load_until(folder, &stop, error);
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
