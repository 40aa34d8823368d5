/* The film object: options that change, and the frames that follow from them. */
#include <fluidy/film.h>

#include "base/alloc.h"
#include "base/error.h"
#include "base/limits.h"
#include "base/schedule.h"
#include "base/suggest.h"
#include "params/options.h"
#include "render/frames.h"
#include <string.h>

enum { TEXTS_BYTES = 4096 }; // of a block of texts

/* The frames of a film by its options, or drafts of them. */
typedef struct Take {
    FlRenderOptions asked; // the options without those of files
    GArray *settings;      // FlSetting, of those options
    FlFrames frames;
    bool open;     // frames follow the options as they were when they changed last
    bool changed;  // since then
    int n_painted; // by painters that are freed
} Take;

struct FlFilm {
    char **inputs;
    FlRenderOptions options; // as they were set; settings are in `settings`
    GPtrArray *strings;      // of values of options, kept until the film is closed
    GStringChunk *texts;     // of settings and configs, each once
    GArray *settings;        // of FlSetting
    int most_side;           // of drafts, px
    Take full, draft;
    FlComposite composite;
    uint8_t *drawing; // the last picture of fl_film_drawing() or fl_film_map()
    bool maps;        // regions are drawn in the colours of the map
    GArray *regions;  // FlFilmRegion, of the last fl_film_regions()
    FlFilmInfo info;
    FlFilmFrame frame;
    FlFilmStats stats;
};

FlFilm *fl_film_open(const char *const *inputs)
{
    FlFilm *film = g_new0(FlFilm, 1);
    film->options.size = sizeof film->options;
    film->inputs = g_strdupv((char **)inputs);
    film->strings = g_ptr_array_new_with_free_func(g_free);
    film->texts = g_string_chunk_new(TEXTS_BYTES);
    film->settings = g_array_new(FALSE, FALSE, sizeof(FlSetting));
    film->full.settings = g_array_new(FALSE, FALSE, sizeof(FlSetting));
    film->draft.settings = g_array_new(FALSE, FALSE, sizeof(FlSetting));
    film->regions = g_array_new(FALSE, FALSE, sizeof(FlFilmRegion));
    return film;
}

void fl_film_close(FlFilm *film)
{
    if (!film)
        return;
    fl_composite_clear(&film->composite);
    if (film->full.open)
        fl_frames_clear(&film->full.frames);
    if (film->draft.open)
        fl_frames_clear(&film->draft.frames);
    g_strfreev(film->inputs);
    g_ptr_array_unref(film->strings);
    g_string_chunk_free(film->texts);
    g_array_unref(film->settings);
    g_array_unref(film->full.settings);
    g_array_unref(film->draft.settings);
    g_array_unref(film->regions);
    g_free(film->drawing);
    g_free(film);
}

/* ---- options --------------------------------------------------------------------------------- */

static const char *keep(FlFilm *film, const char *text)
{
    return text ? g_string_chunk_insert_const(film->texts, text) : NULL;
}

static bool no_such_option(const char *name, GError **error)
{
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (int i = 0; i < fl_option_count(); i++)
        if (fl_option_at(i)->scope != FL_SCOPE_PROGRAM)
            g_ptr_array_add(names, (gpointer)fl_option_at(i)->name);
    g_ptr_array_add(names, NULL);
    g_autofree char *hint = fl_did_you_mean(name, (const char *const *)names->pdata);
    return fl_fail(error, FL_ERROR_USAGE, "no option “%s”%s", name, hint);
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

/* The setting takes the place of an earlier one of the same name. */
static bool set_of_regions(FlFilm *film, const FlSetting *setting, GError **error)
{
    g_auto(FlOverrides) checked = {0}; // regions are checked once they are known
    if (setting->value &&
        !fl_overrides_add(&checked, NULL, setting->name, setting->value, NULL, error))
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

static void mark_changed(FlFilm *film)
{
    film->full.changed = film->draft.changed = true;
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
    if (set)
        mark_changed(film);
    return set;
}

bool fl_film_set_config(FlFilm *film, const char *path, const char *text, GError **error)
{
    const FlRenderOptions given = {.config_text = text};
    g_autoptr(FlConfig) config = text ? fl_config_load(path, &given, error) : NULL;
    if (text && !config)
        return false;
    // another pointer than before, so that the plan reads the file again
    film->options.config = path ? g_string_chunk_insert(film->texts, path) : NULL;
    film->options.config_text = keep(film, text);
    mark_changed(film);
    return true;
}

void fl_film_set_calls(FlFilm *film, const FlFilmCalls *calls)
{
    FlFilmCalls known = {0};
    if (calls)
        memcpy(&known, calls, MIN(calls->size, sizeof known));
    film->options.progress = known.progress;
    film->options.warning = known.warning;
    film->options.note = known.note;
    film->options.stopped = known.stopped;
    film->options.reads = known.reads;
    film->options.data = known.data;
    mark_changed(film);
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
    options.layers = options.paint = options.part = options.audio = NULL;
    options.vectors = options.thickness = false;
    options.report = options.stats = options.dump = options.ebsynth = NULL;
    options.merge = false;
    return options;
}

/* Collects the options and settings of the next frame. Drafts have one detail for all regions. */
static void ask(FlFilm *film, Take *take)
{
    static const FlSetting detail = {NULL, "detail", "draft"};
    const bool drafts = take == &film->draft;
    take->asked = options_of_frames(film);
    g_array_set_size(take->settings, 0);
    for (guint k = 0; k < film->settings->len; k++) {
        const FlSetting *setting = &g_array_index(film->settings, FlSetting, k);
        if (!drafts || strcmp(setting->name, detail.name) != 0)
            g_array_append_val(take->settings, *setting);
    }
    if (drafts)
        g_array_append_val(take->settings, detail);
    take->asked.settings = (const FlSetting *)(const void *)take->settings->data;
    take->asked.n_settings = take->settings->len;
    take->asked.most_side = drafts ? film->most_side : 0;
}

/* ---- frames ---------------------------------------------------------------------------------- */

/* A take that fails keeps its drawing, its styles, its guides and the stored paint for the next
 * options. */
static bool follow_options(FlFilm *film, Take *take, GError **error)
{
    const int most = take == &film->draft ? 64 : 192; // MiB of paint
    const size_t memory = (size_t)MIN(fl_limit(FL_LIMIT_MEMORY) / 8, most) << 20;
    const FlRenderOptions before = take->asked;
    const FlDrawing *read = take->open ? take->frames.plan->shapes.drawing : NULL;
    ask(film, take);
    if (!fl_frames_follow(&take->frames, &take->asked, memory, error)) {
        take->asked = before;
        return false;
    }
    const FlShapes *shapes = &take->frames.plan->shapes;
    take->open = true;
    take->frames.small = take == &film->draft;
    film->stats.n_read += shapes->drawing != read;
    if (fl_frames_check(&take->frames, error) && fl_frames_prepare(&take->frames, error))
        return true;
    FlPainters *painters = &take->frames.painters;
    if (painters->shapes.masks == shapes->masks)
        fl_painters_forget(painters);
    else {
        take->n_painted += fl_painters_painted(painters);
        fl_painters_clear(painters);
    }
    g_clear_pointer(&take->frames.old_plan, fl_plan_free);
    return false;
}

static bool settle(FlFilm *film, Take *take, GError **error)
{
    if (take->open && !take->changed)
        return true;
    if (!follow_options(film, take, error))
        return false;
    const FlShapes *shapes = &take->frames.plan->shapes;
    const double fps = take->frames.plan->out.fps;
    film->info = (FlFilmInfo){.n_frames = shapes->n_frames,
                              .width = shapes->page_width,
                              .height = shapes->page_height,
                              .n_regions = shapes->n_painted,
                              .name = fl_drawing_name(shapes->drawing),
                              .fps = fps > 0 ? fps : 24,
                              .transparent = take->frames.background.none};
    take->changed = false;
    return true;
}

/* Work on a frame of a take, with the threads of the film's options. */
typedef bool (*Work)(FlFilm *film, Take *take, int frame, GError **error);

static bool work_on(FlFilm *film, Take *take, int frame, Work work, GError **error)
{
    const int threads = fl_schedule_threads();
    if (film->options.threads > 0)
        (void)fl_schedule_set_threads(film->options.threads);
    bool done = settle(film, take, error);
    const int n = done ? fl_drawing_frames(take->frames.plan->shapes.drawing) : 0;
    if (done && (frame < 0 || frame >= n)) {
        fl_fail(error, FL_ERROR_USAGE, "frame %d: expected 0 to %d", frame, n - 1);
        done = false;
    }
    done = done && (!work || work(film, take, frame, error));
    (void)fl_schedule_set_threads(threads);
    return done;
}

static const FlFilmFrame *give(FlFilm *film, const FlShapes *shapes, int frame, int width,
                               int height, const uint8_t *rgba)
{
    film->frame =
        (FlFilmFrame){frame, fl_drawing_number(shapes->drawing, frame), width, height, rgba};
    return &film->frame;
}

static bool make_frame(FlFilm *film, Take *take, int frame, GError **error)
{
    FlFrames *frames = &take->frames;
    double paint_s;
    fl_composite_clear(&film->composite);
    if (!(take == &film->draft ? fl_frames_start_at : fl_frames_seek)(frames, frame, error) ||
        !fl_frames_make(frames, frame, -1, &film->composite, &paint_s, error))
        return false;
    film->stats.n_composed++;
    const FlShapes *shapes = &frames->plan->shapes;
    (void)give(film, shapes, frame, frames->small ? shapes->width : shapes->page_width,
               frames->small ? shapes->height : shapes->page_height, film->composite.rgba);
    return true;
}

const FlFilmInfo *fl_film_info(FlFilm *film, GError **error)
{
    return work_on(film, &film->full, 0, NULL, error) ? &film->info : NULL;
}

const FlFilmFrame *fl_film_frame(FlFilm *film, int frame, GError **error)
{
    return work_on(film, &film->full, frame, make_frame, error) ? &film->frame : NULL;
}

int fl_film_number(const FlFilm *film, int frame)
{
    const Take *take = film->draft.open ? &film->draft : &film->full;
    return fl_drawing_number(take->frames.plan->shapes.drawing, frame);
}

/* ---- drafts ---------------------------------------------------------------------------------- */

void fl_film_set_draft_side(FlFilm *film, int most_side)
{
    film->draft.changed |= film->most_side != most_side;
    film->most_side = most_side;
}

const FlFilmInfo *fl_film_draft_info(FlFilm *film, GError **error)
{
    return work_on(film, &film->draft, 0, NULL, error) ? &film->info : NULL;
}

const FlFilmFrame *fl_film_draft(FlFilm *film, int frame, GError **error)
{
    return work_on(film, &film->draft, frame, make_frame, error) ? &film->frame : NULL;
}

/* The drawing in a frame into film->drawing. */
static bool draw_shapes(FlFilm *film, Take *take, int frame, GError **error)
{
    const FlDrawing *drawing = take->frames.plan->shapes.drawing;
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autoptr(FlDrawList) draws =
        fl_drawing_draw_list(drawing, fl_drawing_shown(drawing, frame), error);
    g_autofree uint8_t *rgba =
        draws ? fl_alloc((size_t)width * (size_t)height, 4, "a drawing", error) : NULL;
    if (!rgba)
        return false;
    fl_draw_list_flat(draws, width, height, rgba);
    if (film->maps)
        fl_draw_list_map(drawing, draws, rgba);
    g_free(film->drawing);
    film->drawing = g_steal_pointer(&rgba);
    (void)give(film, &take->frames.plan->shapes, frame, width, height, film->drawing);
    return true;
}

const FlFilmFrame *fl_film_drawing(FlFilm *film, int frame, GError **error)
{
    film->maps = false;
    return work_on(film, &film->draft, frame, draw_shapes, error) ? &film->frame : NULL;
}

const FlFilmFrame *fl_film_map(FlFilm *film, int frame, GError **error)
{
    film->maps = true;
    return work_on(film, &film->draft, frame, draw_shapes, error) ? &film->frame : NULL;
}

const FlFilmRegion *fl_film_regions(FlFilm *film, int *n, GError **error)
{
    if (!work_on(film, &film->draft, 0, NULL, error))
        return NULL;
    const FlShapes *shapes = &film->draft.frames.plan->shapes;
    g_array_set_size(film->regions, 0);
    *n = fl_drawing_regions(shapes->drawing);
    for (int r = 0; r < *n; r++) {
        const FlRegion *region = fl_drawing_region(shapes->drawing, r);
        const int p = shapes->painted_of[r];
        FlFilmRegion told = {.name = region->name,
                             .layer = region->label,
                             .paint = region->paint,
                             .style = p >= 0 ? shapes->painted[p].settings.style : NULL,
                             .left_out = p == FL_LEFT_OUT};
        fl_region_colour(shapes->drawing, r, told.colour);
        g_array_append_val(film->regions, told);
    }
    return (const FlFilmRegion *)(const void *)film->regions->data;
}

/* ---- the whole ------------------------------------------------------------------------------- */

static int painted_in(const Take *take)
{
    return take->n_painted + (take->open ? fl_painters_painted(&take->frames.painters) : 0);
}

const FlFilmStats *fl_film_stats(FlFilm *film)
{
    film->stats.n_painted = painted_in(&film->full) + painted_in(&film->draft);
    return &film->stats;
}

bool fl_film_render(FlFilm *film, GError **error)
{
    const FlRenderOptions options = options_of(film);
    return fl_render(&options, error);
}
