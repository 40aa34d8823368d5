#include "live_film.h"

#include "base/json.h"
#include "params/options.h"

#include <gio/gio.h>
#include <signal.h>
#include <string.h>

enum { DRAFT_SIDE = 500, TELL_MS = 100, HEAD_NUMBERS = 6 };

struct FlLiveFilm {
    const FlArgs *args;
    FlLiveCalls calls;
    GThread *thread;
    GAsyncQueue *jobs; // FlLiveJob; one of generation -1 ends the thread
    GPtrArray *styles; // FlStyleEntry
    GCancellable *end; // of fluidy-frames
    gint wanted;       // generation; atomic

    /* Of the thread alone. */
    FlFilm *film;
    FlLiveJob *job;
    FlLiveJob *settings; // the last job that brought some
    int set;             // generation of those that the film has
    int n_opened;        // films so far
    char *facts;         // that were told last
    gint64 told;         // last progress, microseconds
};

/* ---- the options of the command line ------------------------------------------------------- */

/* An option of the command line that is not in the config, which has all others. */
static bool is_forwarded(const FlOption *option, const FlRenderOptions *options)
{
    static const char *const own[] = {"config", "overwrite", "no-clobber", NULL};
    const char *cache = g_getenv("FLUIDY_CACHE");
    if (strcmp(option->name, "cache") == 0)
        return strcmp(options->cache, cache ? cache : "auto") != 0;
    return option->scope == FL_SCOPE_RENDER && option->section == FL_SECTION_NONE &&
           fl_option_is_set(option, options) && !g_strv_contains(own, option->name);
}

static void append_word(GString *command, const char *word)
{
    const bool plain = strspn(word, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ"
                                    "0123456789-_./=%,+") == strlen(word);
    g_autofree char *quoted = plain ? g_strdup(word) : g_shell_quote(word);
    g_string_append_printf(command, " %s", quoted);
}

char *fl_live_film_command(const FlArgs *args, const char *config)
{
    GString *command = g_string_new("fluidy-svg");
    for (const char *const *input = args->render.inputs; *input; input++)
        append_word(command, *input);
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (!is_forwarded(option, &args->render))
            continue;
        g_string_append_printf(command, " --%s", option->name);
        g_autofree char *value = fl_option_get(option, &args->render);
        if (fl_option_takes_value(option))
            append_word(command, value);
    }
    for (guint i = 0; i < args->limits->len; i++) {
        g_autofree char *limit = g_strconcat("--limit=", args->limits->pdata[i], NULL);
        append_word(command, limit);
    }
    append_word(command, "-c");
    append_word(command, config);
    return g_string_free(command, FALSE);
}

static bool set_options(FlLiveFilm *film, GError **error)
{
    const FlRenderOptions *options = &film->args->render;
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        const bool cache = strcmp(option->name, "cache") == 0;
        if (!cache && !is_forwarded(option, options))
            continue;
        g_autofree char *value = fl_option_get(option, options);
        if (!fl_film_set(film->film, NULL, option->name,
                         fl_option_takes_value(option) ? value : "on", error))
            return false;
    }
    fl_film_set_draft_side(film->film, DRAFT_SIDE);
    return true;
}

/* ---- calls of the film, in its thread ------------------------------------------------------ */

/* A line for the main thread, or a job that has ended. */
typedef struct Line {
    FlLiveFilm *film;
    FlLiveJob *job; // NULL: it is a line
    void (*take)(const char *text, void *data);
    char *text;
} Line;

static gboolean say(void *data)
{
    g_autofree Line *line = data;
    const FlLiveCalls *calls = &line->film->calls;
    if (line->job)
        calls->done(line->job, calls->data);
    else
        line->take(line->text, calls->data);
    g_free(line->text);
    return G_SOURCE_REMOVE;
}

static void send(const Line *line)
{
    g_idle_add_full(G_PRIORITY_DEFAULT, say, g_memdup2(line, sizeof *line), NULL);
}

static bool was_stopped(void *data)
{
    FlLiveFilm *film = data;
    return g_atomic_int_get(&film->wanted) != film->job->generation;
}

static bool on_progress(const FlProgress *progress, void *data)
{
    FlLiveFilm *film = data;
    const gint64 now = g_get_monotonic_time();
    const bool known = film->job->work == FL_LIVE_DRAFT && strcmp(progress->stage, "paint") != 0;
    if (known && now - film->told > (gint64)TELL_MS * 1000) {
        GString *json = g_string_new("{");
        film->told = now;
        fl_json_text(json, "progress", progress->stage);
        fl_json_number(json, "done", progress->done, true);
        fl_json_number(json, "total", progress->total, true);
        g_string_append_c(json, '}');
        send(&(Line){film, NULL, film->calls.progress, g_string_free(json, FALSE)});
    }
    return !was_stopped(film);
}

static void on_warning(const char *message, void *data)
{
    FlLiveFilm *film = data;
    if (film->job->work != FL_LIVE_SAMPLE) // of a style that was not chosen
        send(&(Line){film, NULL, film->calls.warning, g_strdup(message)});
}

static void on_reads(const char *path, void *data)
{
    FlLiveFilm *film = data;
    send(&(Line){film, NULL, film->calls.reads, g_strdup(path)});
}

/* ---- a job --------------------------------------------------------------------------------- */

/* Makes frames of a Lottie animation; *input becomes their folder. */
static bool make_frames(FlLiveFilm *film, char **input, GError **error)
{
    g_autofree char *folder = g_strndup(*input, (gsize)(strrchr(*input, '.') - *input));
    g_autofree char *said = NULL;
    g_autoptr(GSubprocess) process =
        g_subprocess_new(G_SUBPROCESS_FLAGS_STDOUT_SILENCE | G_SUBPROCESS_FLAGS_STDERR_PIPE, error,
                         "fluidy-frames", *input, "-o", folder, NULL);
    if (!process) {
        g_prefix_error(error, "frames of it are made by fluidy-frames; see fluidy-exports(7): ");
        return false;
    }
    const bool ended = g_subprocess_communicate_utf8(process, NULL, film->end, NULL, &said, error);
    if (!ended)
        g_subprocess_send_signal(process, SIGTERM);
    else if (!g_subprocess_get_successful(process))
        fl_fail(error, FL_ERROR_INPUT, "%s", g_strstrip(said));
    else {
        g_free(*input);
        *input = g_steal_pointer(&folder);
    }
    return !folder;
}

static bool open_film(FlLiveFilm *film, GError **error)
{
    const FlFilmCalls calls = {.size = sizeof calls,
                               .progress = on_progress,
                               .warning = on_warning,
                               .stopped = was_stopped,
                               .reads = on_reads,
                               .data = film};
    char **inputs = film->settings->inputs;
    const bool lottie =
        g_str_has_suffix(inputs[0], ".json") || g_str_has_suffix(inputs[0], ".lottie");
    if (lottie && !make_frames(film, &inputs[0], error))
        return false;
    film->film = fl_film_open((const char *const *)inputs);
    film->n_opened++;
    fl_film_set_calls(film->film, &calls);
    return set_options(film, error);
}

/* Brings the film to the settings. */
static bool follow(FlLiveFilm *film, GError **error)
{
    const FlLiveJob *settings = film->settings;
    if (film->set == settings->generation)
        return true;
    if ((!film->film && !open_film(film, error)) ||
        !fl_film_set_config(film->film, settings->path, settings->text, error))
        return false;
    film->set = settings->generation;
    return true;
}

static void take_settings(FlLiveFilm *film, FlLiveJob *settings)
{
    if (settings->anew)
        g_clear_pointer(&film->film, fl_film_close);
    if (film->settings)
        fl_live_job_free(film->settings);
    film->settings = settings;
}

static void add_picture(FlLiveJob *job, FlLiveWork kind, int number, const FlFilmFrame *frame)
{
    const size_t bytes = 4 * (size_t)frame->width * (size_t)frame->height;
    const int head[HEAD_NUMBERS] = {(int)kind, job->generation, number, frame->width,
                                    frame->height};
    GByteArray *picture = g_byte_array_sized_new((guint)(sizeof head + bytes));
    for (int k = 0; k < HEAD_NUMBERS; k++) {
        const guint32 value = GUINT32_TO_LE((guint32)head[k]);
        g_byte_array_append(picture, (const guint8 *)&value, sizeof value);
    }
    g_byte_array_append(picture, frame->rgba, (guint)bytes);
    g_ptr_array_add(job->pictures, g_byte_array_free_to_bytes(picture));
}

static void append_region(GString *json, const FlFilmRegion *region)
{
    g_autofree char *colour =
        g_strdup_printf("#%02x%02x%02x", region->colour[0], region->colour[1], region->colour[2]);
    g_autofree char *style = region->style ? g_path_get_basename(region->style) : NULL;
    fl_json_begin(json, NULL, '{');
    fl_json_text(json, "name", region->name);
    fl_json_text(json, "paint", region->paint);
    fl_json_text(json, "colour", colour);
    fl_json_text(json, "style", style);
    fl_json_number(json, "painter", region->style ? 0 : region->left_out ? -2 : -1, true);
    g_string_append_c(json, '}');
}

static char *facts_of(FlLiveFilm *film, const FlFilmFrame *frame)
{
    int n = 0;
    const int width = frame->width, height = frame->height;
    const FlFilmRegion *region = fl_film_regions(film->film, &n, NULL);
    const FlFilmInfo *info = region ? fl_film_draft_info(film->film, NULL) : NULL;
    if (!info)
        return NULL;
    GString *json = g_string_new("{");
    fl_json_text(json, "name", info->name);
    fl_json_number(json, "width", width, true);
    fl_json_number(json, "height", height, true);
    fl_json_number(json, "fps", info->fps, true);
    fl_json_number(json, "read", film->n_opened + fl_film_stats(film->film)->n_read, true);
    fl_json_bool(json, "transparent", info->transparent);
    fl_json_begin(json, "numbers", '[');
    for (int f = 0; f < info->n_frames; f++)
        fl_json_number(json, NULL, fl_film_number(film->film, f), true);
    g_string_append(json, "],\"regions\":[");
    for (int r = 0; r < n; r++)
        append_region(json, &region[r]);
    g_string_append(json, "]}");
    return g_string_free(json, FALSE);
}

static bool make_draft(FlLiveFilm *film, GError **error)
{
    FlLiveJob *job = film->job;
    const FlFilmInfo *info = fl_film_draft_info(film->film, error);
    if (!info)
        return false;
    job->frame = CLAMP(job->frame, 0, info->n_frames - 1);
    const FlFilmFrame *frame = fl_film_draft(film->film, job->frame, error);
    if (!frame)
        return false;
    add_picture(job, FL_LIVE_DRAFT, job->frame, frame);
    g_autofree char *facts = facts_of(film, frame);
    if (g_strcmp0(facts, film->facts) != 0) {
        job->facts = g_strdup(facts);
        g_free(film->facts);
        film->facts = g_steal_pointer(&facts);
    }
    return true;
}

/* The film of the draft has the style for the moment. */
static bool make_sample(FlLiveFilm *film, GError **error)
{
    const FlLiveJob *job = film->job;
    const FlStyleEntry *style =
        film->styles->pdata[CLAMP(job->style, 0, (int)film->styles->len - 1)];
    if (!fl_film_set(film->film, job->region, "style", style->name, error))
        return false;
    const FlFilmFrame *frame = fl_film_draft(film->film, job->frame, error);
    if (frame)
        add_picture(film->job, FL_LIVE_SAMPLE, job->style, frame);
    return fl_film_set(film->film, job->region, "style", NULL, frame ? error : NULL) && frame;
}

static bool make_picture(FlLiveFilm *film, FlLiveWork kind, GError **error)
{
    const FlFilmFrame *frame =
        (kind == FL_LIVE_FRAME     ? fl_film_frame
         : kind == FL_LIVE_DRAWING ? fl_film_drawing
                                   : fl_film_map)(film->film, film->job->frame, error);
    if (frame)
        add_picture(film->job, kind, film->job->frame, frame);
    return frame;
}

static bool do_job(FlLiveFilm *film, GError **error)
{
    const FlLiveWork work = film->job->work;
    if (was_stopped(film))
        return fl_fail(error, FL_ERROR_INTERRUPTED, "the settings have changed");
    return follow(film, error) &&
           (work == FL_LIVE_DRAFT    ? make_draft(film, error)
            : work == FL_LIVE_SAMPLE ? make_sample(film, error)
                                     : make_picture(film, work, error)) &&
           (work != FL_LIVE_DRAWING || make_picture(film, FL_LIVE_MAP, error));
}

/* ---- the thread ---------------------------------------------------------------------------- */

static void *run(void *data)
{
    FlLiveFilm *film = data;
    while ((film->job = g_async_queue_pop(film->jobs))->generation >= 0) {
        FlLiveJob *job = film->job;
        if (job->inputs) {
            take_settings(film, job);
            continue;
        }
        if (!do_job(film, &job->error) && !job->error)
            g_set_error(&job->error, FL_ERROR, FL_ERROR_NO_MEMORY, "there is not enough memory");
        send(&(Line){film, job});
    }
    g_clear_pointer(&film->film, fl_film_close);
    fl_live_job_free(film->settings);
    fl_live_job_free(film->job);
    return NULL;
}

FlLiveFilm *fl_live_film_new(const FlArgs *args, const FlLiveCalls *calls)
{
    FlLiveFilm *film = g_new0(FlLiveFilm, 1);
    film->args = args;
    film->calls = *calls;
    film->styles = fl_style_list();
    film->end = g_cancellable_new();
    film->jobs = g_async_queue_new_full((GDestroyNotify)fl_live_job_free);
    film->thread = g_thread_new("film", run, film);
    return film;
}

void fl_live_film_set(FlLiveFilm *film, int generation, const char *const *inputs, bool anew,
                      const char *path, const char *text)
{
    FlLiveJob *job = g_new(FlLiveJob, 1);
    *job = (FlLiveJob){.generation = generation,
                       .inputs = g_strdupv((char **)inputs),
                       .anew = anew,
                       .path = g_strdup(path),
                       .text = g_strdup(text)};
    g_atomic_int_set(&film->wanted, generation);
    fl_live_film_ask(film, job);
}

void fl_live_film_ask(FlLiveFilm *film, FlLiveJob *job)
{
    job->pictures = g_ptr_array_new_with_free_func((GDestroyNotify)g_bytes_unref);
    g_async_queue_push(film->jobs, job);
}

void fl_live_job_free(FlLiveJob *job)
{
    g_free(job->region);
    g_strfreev(job->inputs);
    g_free(job->path);
    g_free(job->text);
    g_clear_error(&job->error);
    g_free(job->facts);
    g_clear_pointer(&job->pictures, g_ptr_array_unref);
    g_free(job);
}

void fl_live_film_free(FlLiveFilm *film)
{
    if (!film)
        return;
    g_atomic_int_set(&film->wanted, -1);
    g_cancellable_cancel(film->end);
    FlLiveJob *last = g_new0(FlLiveJob, 1);
    last->generation = -1;
    fl_live_film_ask(film, last);
    g_thread_join(film->thread);
    while (g_main_context_iteration(NULL, FALSE))
        continue; // the last calls of the thread
    g_async_queue_unref(film->jobs);
    g_ptr_array_unref(film->styles);
    g_object_unref(film->end);
    g_free(film->facts);
    g_free(film);
}
