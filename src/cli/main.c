/* fluidy-svg: texts and exit codes only; the work is in the library. */
#include "args.h"
#include "file_watch.h"
#include "help.h"
#include "progress.h"
#include "serve.h"
#include "words.h"

#include "base/error.h"
#include "base/json.h"
#include "config.h"

#include <errno.h>
#include <fcntl.h>
#include <locale.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <signal.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

enum { DONE = 0, FAILURE = 1, USAGE = 2, INTERRUPTED = 75 };

static volatile sig_atomic_t stop;

/* The first signal asks; a second one of either kind finds the default action again. */
static void on_signal(int number)
{
    stop = 1;
    signal(SIGINT, SIG_DFL);
    signal(SIGTERM, SIG_DFL);
}

typedef struct Reporter {
    FlMeter meter;
    bool quiet;
    int n_warnings;
    FlFileWatch *files; // a change stops the render; or NULL
} Reporter;

static bool show_progress(const FlProgress *progress, void *data)
{
    Reporter *reporter = data;
    fl_meter_show(&reporter->meter, progress);
    return !stop && !(reporter->files && fl_file_watch_changed(reporter->files));
}

static bool was_stopped(void *data)
{
    const Reporter *reporter = data;
    return stop || (reporter->files && fl_file_watch_has_changed(reporter->files));
}

/* Prints a message with options as --name. */
static void say(Reporter *reporter, const char *kind, const char *message)
{
    g_autofree char *line = fl_help_translate(message);
    if (!reporter->quiet)
        fl_meter_say(&reporter->meter, kind, line);
}

static void show_warning(const char *message, void *data)
{
    Reporter *reporter = data;
    reporter->n_warnings++;
    say(reporter, "warning", message);
}

/* Reminds at the end of warnings that may have scrolled away. */
static void recall_warnings(Reporter *reporter)
{
    const int n = reporter->n_warnings;
    g_autofree char *line = g_strdup_printf("%d warning%s at the beginning", n, n == 1 ? "" : "s");
    if (n > 0 && !reporter->quiet)
        fl_meter_say(&reporter->meter, "note", line);
}

static void show_note(const char *message, void *data)
{
    say(data, "note", message);
}

/* The live viewer reads it among the lines of JSON. */
static void take_input(const char *path, void *data)
{
    Reporter *reporter = data;
    if (reporter->files)
        fl_file_watch_add(reporter->files, path);
    else if (reporter->meter.mode == FL_PROGRESS_JSON)
        fl_meter_say(&reporter->meter, "reads", path);
}

static int status_of(const GError *error)
{
    if (g_error_matches(error, FL_ERROR, FL_ERROR_INTERRUPTED))
        return INTERRUPTED;
    const bool usage =
        error->domain == G_OPTION_ERROR || g_error_matches(error, FL_ERROR, FL_ERROR_USAGE);
    return usage ? USAGE : FAILURE;
}

/* One line, whatever the library below wrote. */
static int fail(const FlArgs *args, const GError *error)
{
    FlMeter meter;
    fl_meter_init(&meter, args->progress, stderr);
    g_autofree char *text = fl_help_translate(error->message);
    fl_meter_say(&meter, "error", text);
    fflush(stderr);
    return status_of(error);
}

static int print(const char *text)
{
    const bool written = fputs(text, stdout) >= 0 && fflush(stdout) == 0;
    if (!written)
        fprintf(stderr, "fluidy-svg: standard output cannot be written: %s\n", g_strerror(errno));
    return written ? DONE : FAILURE;
}

/* Lists are tables, or JSON; other formats are those of frames. */
static bool wants_json(const FlArgs *args, bool *json, GError **error)
{
    const char *format = args->render.format;
    *json = format && strcmp(format, "json") == 0;
    if (!format || *json)
        return true;
    return fl_fail(error, FL_ERROR_USAGE, "--format %s: lists are written as tables or as json",
                   format);
}

static void append_line(GString *text, const FlStyleEntry *style)
{
    g_string_append_printf(text, "%-4s %-13s %s\n", style->name, style->title ? style->title : "",
                           style->character ? style->character : style->path);
}

static void append_object(GString *text, const FlStyleEntry *style)
{
    fl_json_begin(text, NULL, '{');
    fl_json_text(text, "style", style->name);
    fl_json_text(text, "name", style->title);
    fl_json_text(text, "character", style->character);
    fl_json_text(text, "folder", style->path);
    g_string_append_c(text, '}');
}

static int list_styles(const FlArgs *args)
{
    g_autoptr(GError) error = NULL;
    const bool overwrite = args->render.overwrite == FL_OVERWRITE_YES;
    bool json;
    if ((args->render.output && !fl_style_sheet(args->render.output, overwrite, &error)) ||
        !wants_json(args, &json, &error))
        return fail(args, error);
    g_autoptr(GPtrArray) styles = fl_style_list();
    g_autoptr(GString) text = g_string_new(json ? "[" : NULL);
    for (guint i = 0; i < styles->len; i++) {
        const FlStyleEntry *style = styles->pdata[i];
        if (!style->hidden)
            (json ? append_object : append_line)(text, style);
    }
    g_string_append(text, json ? "\n]\n" : "");
    return print(text->str);
}

static bool compare_styles(const FlArgs *args, GError **error)
{
    g_autoptr(GPtrArray) found = fl_style_list();
    g_autoptr(GPtrArray) names = g_ptr_array_new();
    for (guint i = 0; i < found->len; i++) {
        const FlStyleEntry *style = found->pdata[i];
        if (!style->hidden)
            g_ptr_array_add(names, style->name);
    }
    g_ptr_array_add(names, NULL);
    char **styles = args->variants ? args->variants : (char **)names->pdata;
    return fl_compare_styles(&args->render, (const char *const *)styles, error);
}

static int list_regions(const FlArgs *args, FlListing listing, GError **error)
{
    bool json;
    if (!wants_json(args, &json, error))
        return FAILURE;
    if (json && listing == FL_LISTING_TABLE)
        listing = FL_LISTING_JSON;
    g_autofree char *text = fl_list_regions(&args->render, listing, error);
    return text ? print(text) : FAILURE;
}

static int plan_farm(const FlArgs *args, GError **error)
{
    g_autofree char *text =
        fl_farm_plan(&args->render, args->farm, (const char *const *)args->command, error);
    return text ? print(text) : FAILURE;
}

/* ---- watching ---------------------------------------------------------------------------- */

/* A draft of all regions first, and then as asked for, unless that is a draft as well. What is odd
 * about the input is said once. */
static bool paint_twice(const FlArgs *args, GError **error)
{
    FlRenderOptions full = args->render, draft = full;
    const FlSetting quick = {.name = "detail", .value = "draft"};
    bool drafts = full.dry_run;
    for (size_t k = 0; k < full.n_settings; k++)
        if (strcmp(full.settings[k].name, quick.name) == 0)
            drafts = strcmp(full.settings[k].value, quick.value) == 0;
    if (drafts)
        return fl_render(&full, error);
    g_autoptr(GArray) settings = g_array_new(FALSE, FALSE, sizeof quick);
    g_array_append_vals(settings, full.settings, (guint)full.n_settings);
    g_array_append_val(settings, quick);
    draft.settings = (const FlSetting *)(const void *)settings->data;
    draft.n_settings = settings->len;
    full.overwrite = FL_OVERWRITE_YES;
    full.warning = NULL;
    return fl_render(&draft, error) && fl_render(&full, error);
}

/* True if the error stays until the command line changes. */
static bool is_final(const FlArgs *args, const GError *error)
{
    return g_error_matches(error, FL_ERROR, FL_ERROR_EXISTS) ||
           (status_of(error) == USAGE && !args->render.config);
}

static void note_change(Reporter *reporter)
{
    g_autofree char *line = g_strdup_printf("%s has changed", fl_file_watch_last(reporter->files));
    say(reporter, "note", line);
}

/* Paints. If this fails because a file is changing, the next round starts soon.
 * Returns: the status of the program; -1: the next round follows. */
static int watch_round(FlArgs *args, Reporter *reporter)
{
    g_autoptr(GError) error = NULL;
    reporter->n_warnings = 0;
    const bool painted = paint_twice(args, &error);
    fl_meter_hide(&reporter->meter);
    if (painted)
        recall_warnings(reporter);
    else if (stop || !fl_file_watch_changed(reporter->files)) {
        const int status = fail(args, error);
        if (stop || is_final(args, error))
            return status;
    }
    args->render.overwrite = FL_OVERWRITE_YES; // from now on the frames are ours
    return -1;
}

/* True if the configs can be read again: none is a pipe. */
static bool can_reread_config(const FlArgs *args, const char *option, GError **error)
{
    g_auto(GStrv) paths = fl_options_configs(args->render.config);
    for (char **path = paths; *path; path++)
        if (g_file_test(*path, G_FILE_TEST_EXISTS) && !g_file_test(*path, G_FILE_TEST_IS_REGULAR))
            return fl_fail(error, FL_ERROR_USAGE,
                           "%s: %s: expected a file, which can be read again", option, *path);
    return true;
}

static int watch(FlArgs *args, Reporter *reporter)
{
    g_autoptr(GError) error = NULL;
    if (!can_reread_config(args, "--watch", &error))
        return fail(args, error);
    int status = -1;
    (void)fl_start_workers(); // before the watch starts a thread; a reading without them warns
    if (!fl_file_watch_works(&error))
        return fail(args, error);
    g_autoptr(FlFileWatch) before = NULL;
    while (status < 0) {
        FlFileWatch *files = fl_file_watch_new(args->render.inputs, args->render.config);
        if (before)
            fl_file_watch_add_all(files, before);
        fl_file_watch_free(before);
        before = files;
        reporter->files = files;
        status = watch_round(args, reporter);
        if (status < 0 && !fl_file_watch_changed(files))
            say(reporter, "note", "waiting for a change of drawings, config or styles");
        if (status < 0 && !fl_file_watch_wait(files, &stop))
            status = DONE;
        else if (status < 0)
            note_change(reporter);
        reporter->files = NULL;
    }
    return status;
}

static int serve(FlArgs *args, GError **error)
{
#if HAVE_SOUP
    return can_reread_config(args, "--serve", error) && fl_serve(args, &stop, error) ? DONE
                                                                                     : FAILURE;
#else
    fl_fail(error, FL_ERROR_USAGE, "--serve: this build has no live page; it needs libsoup 3");
    return FAILURE;
#endif
}

/* The commands that read the drawing, and may be interrupted. */
static int work(FlArgs *args)
{
    Reporter reporter = {.quiet = args->quiet};
    fl_meter_init(&reporter.meter, args->quiet ? FL_PROGRESS_NONE : args->progress, stderr);
    args->render.progress = show_progress;
    args->render.stopped = was_stopped;
    args->render.warning = show_warning;
    args->render.note = show_note;
    args->render.reads = take_input;
    args->render.data = &reporter;
    signal(SIGINT, on_signal);
    signal(SIGTERM, on_signal);
    if (args->task == FL_COMMAND_RENDER)
        signal(SIGPIPE, SIG_IGN); // the reader of the progress may exit first
    g_autoptr(GError) error = NULL;
    int status = DONE;
    if (args->task == FL_COMMAND_LIST_REGIONS)
        status = list_regions(args, FL_LISTING_TABLE, &error);
    else if (args->task == FL_COMMAND_PRINT_CONFIG)
        status = list_regions(args, FL_LISTING_CONFIG, &error);
    else if (args->task == FL_COMMAND_PLAN)
        status = plan_farm(args, &error);
    else if (args->task == FL_COMMAND_CHECK)
        fl_map_regions(&args->render, &error);
    else if (args->task == FL_COMMAND_FLAT)
        fl_flatten(&args->render, &error);
    else if (args->task == FL_COMMAND_SAVE_LOOK)
        fl_save_look(&args->render, args->look, &error);
    else if (args->task == FL_COMMAND_COMPARE)
        compare_styles(args, &error);
    else if (args->task == FL_COMMAND_METHODS)
        fl_compare_methods(&args->render, (const char *const *)args->variants, &error);
    else if (args->task == FL_COMMAND_SERVE || args->task == FL_COMMAND_WINDOW)
        status = serve(args, &error);
    else if (args->render.watch)
        status = watch(args, &reporter);
    else
        fl_render(&args->render, &error);
    fl_meter_hide(&reporter.meter);
    if (!error && args->task == FL_COMMAND_RENDER && !args->render.watch)
        recall_warnings(&reporter);
    // NOLINTNEXTLINE(clang-analyzer-core.StackAddressEscape): args are only cleared after this
    return error ? fail(args, error) : status;
}

static int run(FlArgs *args)
{
    g_autofree char *text = NULL;
    switch (args->task) {
    case FL_COMMAND_VERSION:
        text = g_strdup_printf("fluidy-svg %s\n", fl_version());
        return print(text);
    case FL_COMMAND_HELP:
    case FL_COMMAND_HELP_ALL:
        text = fl_help_text(args->task == FL_COMMAND_HELP_ALL);
        return print(text);
    case FL_COMMAND_LIST_STYLES:
        return list_styles(args);
    default:
        return work(args);
    }
}

/* A standard stream that is closed would become the first file that is opened. The file that takes
 * its place cannot be written, so that printing is still an error. */
static void fill_standard_streams(void)
{
    int fd;
    do
        fd = open("/dev/null", O_RDONLY);
    while (fd >= 0 && fd <= STDERR_FILENO);
    if (fd >= 0)
        close(fd);
}

/* glibc gives every thread its own heap, and no thread can use the planes that another one has
 * freed: memory grew with the film. So all threads share a heap, unless planes are small and
 * threads would mostly wait for each other: see fl_memory_separate_heaps(). glibc would return the
 * freed memory of each frame to the system and ask for it again in the next frame. */
static void share_one_heap(void)
{
#ifdef __GLIBC__
    enum { PLANE_BYTES = 32 << 20, KEPT_BYTES = 128 << 20 };
    if (!g_getenv("MALLOC_ARENA_MAX"))
        mallopt(M_ARENA_MAX, 1);
    mallopt(M_MMAP_THRESHOLD, PLANE_BYTES);
    mallopt(M_TRIM_THRESHOLD, KEPT_BYTES);
#endif
}

int main(int argc, char **argv)
{
    fl_wait_asleep(argv);
    signal(SIGXFSZ, SIG_IGN); // a limit on the size of files is an error of writing
    share_one_heap();
    fill_standard_streams();
    setlocale(LC_CTYPE, "");
    FlArgs args;
    g_autoptr(GError) error = NULL;
    const int status = fl_args_parse(&args, argc, argv, &error) ? run(&args) : fail(&args, error);
    fl_args_clear(&args);
    return status;
}
