/* The film object: options that change, and the frames that follow from them. */
#include <fluidy/film.h>

#include "base/limits.h"
#include "base/schedule.h"
#include "base/suggest.h"
#include "params/options.h"
#include "render/frames.h"
#include <string.h>

struct FlFilm {
    char **inputs;
    FlRenderOptions options; // as they were set; settings are in `settings`
    FlRenderOptions asked;   // of the frames: the options without those of files
    GPtrArray *strings;      // of the options, kept until the film is closed
    GArray *settings;        // of FlSetting
    FlFrames frames;
    bool open;    // frames follow the options as they were when they changed last
    bool changed; // since then
    FlComposite composite;
    FlFilmInfo info;
    FlFilmFrame frame;
    FlFilmStats stats;
    int n_painted; // before the film was opened last
};

FlFilm *fl_film_open(const char *const *inputs)
{
    FlFilm *film = g_new0(FlFilm, 1);
    film->inputs = g_strdupv((char **)inputs);
    film->strings = g_ptr_array_new_with_free_func(g_free);
    film->settings = g_array_new(FALSE, FALSE, sizeof(FlSetting));
    return film;
}

/* Frees the drawing and all data derived from the drawing; the next frame reads it again. */
static void forget(FlFilm *film)
{
    fl_composite_clear(&film->composite);
    if (film->open)
        film->n_painted += fl_painters_painted(&film->frames.painters);
    if (film->open)
        fl_frames_clear(&film->frames);
    film->open = false;
}

void fl_film_close(FlFilm *film)
{
    if (!film)
        return;
    forget(film);
    g_strfreev(film->inputs);
    g_ptr_array_unref(film->strings);
    g_array_unref(film->settings);
    g_free(film);
}

/* ---- options --------------------------------------------------------------------------------- */

static const char *keep(FlFilm *film, const char *text)
{
    char *copy = g_strdup(text);
    if (copy)
        g_ptr_array_add(film->strings, copy);
    return copy;
}

static bool no_such_option(const char *name, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int i = 0; i < fl_option_count(); i++)
        if (fl_option_at(i)->scope != FL_SCOPE_PROGRAM)
            g_ptr_array_add(names, (gpointer)fl_option_at(i)->name);
    g_ptr_array_add(names, NULL);
    g_autofree char *hint = fl_did_you_mean(name, (const char *const *)names->pdata);
    g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "no option “%s”%s", name, hint);
    return false;
}

static bool set_of_film(FlFilm *film, const FlOption *option, const char *value, GError **error)
{
    static const FlRenderOptions defaults;
    if (!value) {
        fl_option_copy(option, &defaults, &film->options);
        return true;
    }
    if (fl_option_set(option, value, NULL, &film->options, film->strings, error))
        return true;
    g_prefix_error(error, "%s: ", option->name);
    return false;
}

/* Checks a setting alone; regions are checked once they are known. */
static bool check_setting(const FlSetting *setting, GError **error)
{
    const FlRenderOptions options = {.settings = setting, .n_settings = 1};
    g_auto(FlRegionSettings) settings = {0};
    g_autoptr(FlConfig) none = fl_config_load(NULL, NULL, error);
    return none && fl_config_region_settings(none, -1, setting->region ? setting->region : "",
                                             &options, &settings, error);
}

/* The setting takes the place of an earlier one of the same name. */
static bool set_of_regions(FlFilm *film, const FlSetting *setting, GError **error)
{
    if (setting->value && !check_setting(setting, error))
        return false;
    for (guint k = film->settings->len; k-- > 0;) {
        const FlSetting *old = &g_array_index(film->settings, FlSetting, k);
        if (g_str_equal(old->name, setting->name) && g_strcmp0(old->region, setting->region) == 0)
            g_array_remove_index(film->settings, k);
    }
    const FlSetting kept = {keep(film, setting->region), keep(film, setting->name),
                            keep(film, setting->value)};
    if (setting->value)
        g_array_append_val(film->settings, kept);
    return true;
}

bool fl_film_set(FlFilm *film, const char *region, const char *name, const char *value,
                 GError **error)
{
    const FlSetting setting = {region, name, value};
    const FlOption *option = region ? NULL : fl_option_find(FL_SCOPE_RENDER, name);
    if (!option && !fl_option_find(FL_SCOPE_REGION, name))
        return no_such_option(name, error);
    const bool set =
        option ? set_of_film(film, option, value, error) : set_of_regions(film, &setting, error);
    film->changed = film->changed || set;
    return set;
}

void fl_film_set_calls(FlFilm *film, const FlFilmCalls *calls)
{
    FlFilmCalls known = {0};
    if (calls)
        memcpy(&known, calls, MIN(calls->size, sizeof known));
    film->options.progress = known.progress;
    film->options.warning = known.warning;
    film->options.note = known.note;
    film->options.data = known.data;
    film->changed = true;
}

static FlRenderOptions options_of(const FlFilm *film)
{
    FlRenderOptions options = film->options;
    options.inputs = (const char *const *)film->inputs;
    options.settings = (const FlSetting *)(const void *)film->settings->data;
    options.n_settings = film->settings->len;
    return options;
}

/* Frames are given to the program, and no file is written. */
static FlRenderOptions options_of_frames(const FlFilm *film)
{
    FlRenderOptions options = options_of(film);
    options.output = NULL, options.format = "null", options.no_frames = false;
    options.overwrite = FL_OVERWRITE_YES, options.resume = options.dry_run = false;
    options.layers = options.paint = options.part = NULL;
    options.report = options.stats = options.dump = options.ebsynth = NULL;
    options.merge = false;
    return options;
}

/* ---- frames ---------------------------------------------------------------------------------- */

/* A film that is open stays so if its new options are wrong. */
static bool follow_options(FlFilm *film, GError **error)
{
    const size_t memory = (size_t)MIN(fl_limit(FL_LIMIT_MEMORY) / 4, 1024) << 20;
    const FlRenderOptions before = film->asked;
    const FlDrawing *read = film->open ? film->frames.plan->drawing : NULL;
    film->asked = options_of_frames(film);
    FlPlan *plan =
        fl_plan_follow(film->open ? film->frames.plan : NULL, &film->asked, memory, error);
    if (!plan) {
        film->asked = before;
        return false;
    }
    if (film->open)
        fl_frames_follow(&film->frames, plan);
    else
        fl_frames_init(&film->frames, plan);
    film->open = true;
    film->stats.n_read += plan->drawing != read;
    if (fl_frames_check(&film->frames, error) && fl_frames_prepare(&film->frames, error))
        return true;
    forget(film);
    return false;
}

static bool settle(FlFilm *film, GError **error)
{
    if (film->open && !film->changed)
        return true;
    if (!follow_options(film, error))
        return false;
    const FlPlan *plan = film->frames.plan;
    film->info =
        (FlFilmInfo){fl_drawing_frames(plan->drawing), plan->width, plan->height, plan->n_painted};
    film->changed = false;
    return true;
}

static bool make_frame(FlFilm *film, int frame, GError **error)
{
    FlFrames *frames = &film->frames;
    double paint_s;
    fl_composite_clear(&film->composite);
    if (frame < 0 || frame >= film->info.n_frames) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE, "frame %d: expected 0 to %d", frame,
                    film->info.n_frames - 1);
        return false;
    }
    if (!fl_frames_seek(frames, frame, error) ||
        !fl_frames_make(frames, frame, -1, &film->composite, &paint_s, error))
        return false;
    film->stats.n_composed++;
    film->frame = (FlFilmFrame){frame, fl_drawing_number(frames->plan->drawing, frame),
                                film->info.width, film->info.height, film->composite.rgba};
    return true;
}

/* Runs with the threads of the film's options. */
static bool with_threads(FlFilm *film, int frame, bool (*work)(FlFilm *, int, GError **),
                         GError **error)
{
    const int threads = fl_schedule_threads();
    if (film->options.threads > 0)
        (void)fl_schedule_set_threads(film->options.threads);
    const bool done = settle(film, error) && (!work || work(film, frame, error));
    (void)fl_schedule_set_threads(threads);
    return done;
}

const FlFilmInfo *fl_film_info(FlFilm *film, GError **error)
{
    return with_threads(film, 0, NULL, error) ? &film->info : NULL;
}

const FlFilmFrame *fl_film_frame(FlFilm *film, int frame, GError **error)
{
    return with_threads(film, frame, make_frame, error) ? &film->frame : NULL;
}

const FlFilmStats *fl_film_stats(FlFilm *film)
{
    film->stats.n_painted =
        film->n_painted + (film->open ? fl_painters_painted(&film->frames.painters) : 0);
    return &film->stats;
}

bool fl_film_render(FlFilm *film, GError **error)
{
    const FlRenderOptions options = options_of(film);
    return fl_render(&options, error);
}
