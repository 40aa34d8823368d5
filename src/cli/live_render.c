#include "live_render.h"

#include "base/json.h"
#include "params/options.h"

#include <gio/gio.h>
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>

enum { DRAFT_SIDE = 480, PATIENCE_MS = 300 }; // the pictures of the page are no larger

struct FlLiveRender {
    const FlArgs *args;
    FlTakeInput reads;
    void *data;
    int width, draft_width; // px
    char *folder, *config;  // temporary
    char *preview;
    bool drafts_only;
    FlLiveState state;
    char *progress;
    GSubprocess *process; // NULL while idle
    GCancellable *ended;  // of its streams; set when its lines are no longer wanted
    bool painted;         // it ended well
    bool again;           // begin anew when the process has ended
    FlLiveStep first;     // to begin with
    guint patience;       // timer after which the process is killed; or 0
    int n_pending;        // callbacks to come
};

static void run_step(FlLiveRender *render, FlLiveStep step);

/* ---- the command --------------------------------------------------------------------------- */

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

static bool is_size(const FlOption *option)
{
    static const char *const sizes[] = {"width", "height", "scale", NULL};
    return g_strv_contains(sizes, option->name);
}

static void add_options(const FlArgs *args, bool sizes, GPtrArray *words)
{
    for (int i = 0; i < fl_option_count(); i++) {
        const FlOption *option = fl_option_at(i);
        if (!is_forwarded(option, &args->render) || (is_size(option) && !sizes))
            continue;
        g_ptr_array_add(words, g_strdup_printf("--%s", option->name));
        if (fl_option_takes_value(option))
            g_ptr_array_add(words, fl_option_get(option, &args->render));
    }
    for (guint i = 0; i < args->limits->len; i++)
        g_ptr_array_add(words, g_strdup_printf("--limit=%s", (char *)args->limits->pdata[i]));
}

void fl_live_render_options(const FlArgs *args, GPtrArray *words)
{
    add_options(args, true, words);
}

static GPtrArray *command_of(const FlLiveRender *render, FlLiveStep step)
{
    GPtrArray *words = g_ptr_array_new_with_free_func(g_free);
    const bool draft = step != FL_LIVE_FULL, smaller = draft && render->draft_width < render->width;
    const char *const fixed[] = {"--config", render->config, "--report",   "-",
                                 "--format", "null",         "--progress", "json"};
    g_ptr_array_add(words, g_file_read_link("/proc/self/exe", NULL));
    add_options(render->args, !smaller, words);
    for (size_t k = 0; k < G_N_ELEMENTS(fixed); k++)
        g_ptr_array_add(words, g_strdup(fixed[k]));
    if (smaller)
        g_ptr_array_add(words, g_strdup_printf("--width=%d", render->draft_width));
    if (draft)
        g_ptr_array_add(words, g_strdup("--detail=draft"));
    if (step == FL_LIVE_PREVIEW)
        g_ptr_array_add(words, g_strdup_printf("--frames=%s", render->preview));
    g_ptr_array_add(words, g_strdup("--"));
    for (const char *const *input = render->args->render.inputs; *input; input++)
        g_ptr_array_add(words, g_strdup(*input));
    g_ptr_array_add(words, NULL);
    return words;
}

/* ---- messages of the process ------------------------------------------------------------------
 */

/* A stream of the process, read line by line. */
typedef struct Stream {
    FlLiveRender *render;
    GDataInputStream *lines;
    GCancellable *ended;
    void (*take)(FlLiveRender *render, const char *line);
} Stream;

static void read_next(Stream *stream);
static void came_back(FlLiveRender *render);

static void on_line(GObject *object, GAsyncResult *result, void *data)
{
    Stream *stream = data;
    FlLiveRender *render = stream->render;
    g_autofree char *line = g_data_input_stream_read_line_finish(stream->lines, result, NULL, NULL);
    if (line && !g_cancellable_is_cancelled(stream->ended)) {
        stream->take(render, line);
        read_next(stream);
    } else {
        g_object_unref(stream->lines);
        g_object_unref(stream->ended);
        g_free(stream);
    }
    came_back(render);
}

static void read_next(Stream *stream)
{
    stream->render->n_pending++;
    g_data_input_stream_read_line_async(stream->lines, G_PRIORITY_DEFAULT, stream->ended, on_line,
                                        stream);
}

static void read_stream(FlLiveRender *render, GInputStream *input,
                        void (*take)(FlLiveRender *render, const char *line))
{
    Stream *stream = g_new(Stream, 1);
    *stream = (Stream){render, g_data_input_stream_new(input), g_object_ref(render->ended), take};
    read_next(stream);
}

const char *fl_live_step_name(FlLiveStep step)
{
    static const char *const names[] = {"preview", "draft", "full", "done", "failed"};
    return names[step];
}

/* The film, a frame and the results are scripts of one line each. */
static void take_page(FlLiveRender *render, const char *line)
{
    g_string_append_printf(render->state.page, "%s\n", line);
    if (!g_str_has_prefix(line, "<script>") || !g_str_has_suffix(line, "</script>"))
        return;
    g_autofree char *script = g_strndup(line + 8, strlen(line) - strlen("<script></script>"));
    g_autoptr(GString) json = g_string_new("{");
    fl_json_text(json, "step", fl_live_step_name(render->state.step));
    fl_json_text(json, "script", script);
    g_string_append_c(json, '}');
    g_ptr_array_add(render->state.lines, g_string_free(g_steal_pointer(&json), FALSE));
}

/* The process names the copy of the config; its user knows her own. */
static char *name_config(const FlLiveRender *render, const char *line)
{
    const char *name = render->args->render.config;
    g_autoptr(GString) text = g_string_new(line);
    g_string_replace(text, render->config, name ? name : "config", 0);
    return g_string_free(g_steal_pointer(&text), FALSE);
}

/* {"reads":"PATH"}: quotes and backslashes have a backslash before them. */
static void take_input(const FlLiveRender *render, const char *line)
{
    const size_t before = strlen("{\"reads\":\""), after = strlen("\"}"), all = strlen(line);
    if (all < before + after)
        return;
    g_autofree char *text = g_strndup(line + before, all - before - after);
    g_autofree char *file = g_strcompress(text);
    render->reads(file, render->data);
}

static void take_message(FlLiveRender *render, const char *line)
{
    if (g_str_has_prefix(line, "{\"reads\"")) {
        take_input(render, line);
        return;
    }
    if (g_str_has_prefix(line, "{\"stage\"")) {
        g_free(render->progress);
        render->progress = g_strdup(line);
    } else if (g_str_has_prefix(line, "{\"warning\"") || g_str_has_prefix(line, "{\"error\""))
        g_ptr_array_add(render->state.messages, name_config(render, line));
    else if (*line != '{') {
        g_autoptr(GString) json = g_string_new("{");
        fl_json_text(json, "error", line);
        g_ptr_array_add(render->state.messages, g_strdup_printf("%s}", json->str));
    }
}

/* ---- the process ---------------------------------------------------------------------------- */

static FlLiveStep step_after(const FlLiveRender *render, bool painted)
{
    switch (render->state.step) {
    case FL_LIVE_PREVIEW: // its frame may be gone; the film is not
        return FL_LIVE_DRAFT;
    case FL_LIVE_DRAFT:
        return !painted ? FL_LIVE_FAILED : render->drafts_only ? FL_LIVE_DONE : FL_LIVE_FULL;
    default:
        return painted ? FL_LIVE_DONE : FL_LIVE_FAILED;
    }
}

static void go_on(FlLiveRender *render, FlLiveStep step)
{
    render->state.step = step;
    if (step < FL_LIVE_DONE)
        run_step(render, step);
}

/* A callback has come; after the last one the process has ended, and its streams are read. */
static void came_back(FlLiveRender *render)
{
    if (--render->n_pending > 0)
        return;
    const bool again = render->again;
    render->again = false;
    if (again)
        go_on(render, render->first);
    else if (!g_cancellable_is_cancelled(render->ended))
        go_on(render, step_after(render, render->painted));
}

static void on_end(GObject *object, GAsyncResult *result, void *data)
{
    FlLiveRender *render = data;
    g_autoptr(GSubprocess) process = g_steal_pointer(&render->process);
    render->painted = g_subprocess_wait_check_finish(process, result, NULL);
    if (render->patience)
        g_source_remove(render->patience);
    render->patience = 0;
    came_back(render);
}

static gboolean lose_patience(void *data)
{
    FlLiveRender *render = data;
    render->patience = 0;
    g_subprocess_force_exit(render->process);
    return G_SOURCE_REMOVE;
}

static void tell_failure(FlLiveRender *render, const GError *error)
{
    g_autoptr(GString) json = g_string_new("{");
    fl_json_text(json, "error", error->message);
    g_ptr_array_add(render->state.messages, g_strdup_printf("%s}", json->str));
    render->state.step = FL_LIVE_FAILED;
}

static void run_step(FlLiveRender *render, FlLiveStep step)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(GPtrArray) command = command_of(render, step);
    render->state.step = step;
    g_ptr_array_set_size(render->state.messages, 0);
    g_string_truncate(render->state.page, 0);
    g_clear_pointer(&render->progress, g_free);
    g_clear_object(&render->ended);
    render->ended = g_cancellable_new();
    render->process =
        g_subprocess_newv((const char *const *)command->pdata,
                          G_SUBPROCESS_FLAGS_STDOUT_PIPE | G_SUBPROCESS_FLAGS_STDERR_PIPE, &error);
    if (!render->process) {
        tell_failure(render, error);
        return;
    }
    read_stream(render, g_subprocess_get_stdout_pipe(render->process), take_page);
    read_stream(render, g_subprocess_get_stderr_pipe(render->process), take_message);
    render->n_pending++;
    g_subprocess_wait_async(render->process, NULL, on_end, render);
}

/* A frame that is nearly painted may still reach the cache. */
static void end_process(FlLiveRender *render)
{
    g_cancellable_cancel(render->ended);
    if (render->process)
        g_subprocess_send_signal(render->process, SIGTERM);
    if (render->process && !render->patience)
        render->patience = g_timeout_add(PATIENCE_MS, lose_patience, render);
}

/* ---- the whole ------------------------------------------------------------------------------ */

FlLiveRender *fl_live_render_new(const FlArgs *args, int width, int larger, FlTakeInput reads,
                                 void *data, GError **error)
{
    g_autoptr(FlLiveRender) render = g_new0(FlLiveRender, 1);
    render->args = args;
    render->reads = reads, render->data = data;
    render->width = width;
    render->draft_width = MAX((int)(width * MIN(DRAFT_SIDE / (double)larger, 1) + 0.5), 1);
    render->state.step = FL_LIVE_DONE;
    render->state.lines = g_ptr_array_new_with_free_func(g_free);
    render->state.messages = g_ptr_array_new_with_free_func(g_free);
    render->state.page = g_string_new(NULL);
    render->folder = g_dir_make_tmp("fluidy-svg-XXXXXX", error);
    if (!render->folder)
        return NULL;
    render->config = g_build_filename(render->folder, "live.conf", NULL);
    return g_steal_pointer(&render);
}

void fl_live_render_start(FlLiveRender *render, const char *config, const char *preview,
                          bool drafts_only)
{
    g_autoptr(GError) error = NULL;
    g_free(render->preview);
    render->preview = g_strdup(preview);
    render->drafts_only = drafts_only;
    g_ptr_array_set_size(render->state.lines, 0);
    render->first = preview ? FL_LIVE_PREVIEW : FL_LIVE_DRAFT;
    if (!g_file_set_contents(render->config, config, -1, &error))
        tell_failure(render, error);
    else if (render->n_pending > 0) {
        render->again = true;
        end_process(render);
    } else
        run_step(render, render->first);
}

FlLiveState fl_live_render_state(const FlLiveRender *render)
{
    FlLiveState state = render->state;
    state.progress = render->progress;
    return state;
}

void fl_live_render_free(FlLiveRender *render)
{
    if (!render)
        return;
    render->again = false;
    if (render->n_pending > 0)
        end_process(render);
    while (render->n_pending > 0)
        g_main_context_iteration(NULL, TRUE);
    if (render->config)
        g_unlink(render->config);
    if (render->folder)
        g_rmdir(render->folder);
    g_clear_object(&render->ended);
    g_ptr_array_unref(render->state.lines);
    g_ptr_array_unref(render->state.messages);
    g_string_free(render->state.page, TRUE);
    g_free(render->progress);
    g_free(render->preview);
    g_free(render->config);
    g_free(render->folder);
    g_free(render);
}
