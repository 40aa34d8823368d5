#include "file_watch.h"

#include "base/style_parts.h"
#include "config_edit.h"
#include "params/options.h"
#include <gio/gio.h>
#include <stdatomic.h>
#include <string.h>

enum { TICK_MS = 50, SETTLE_MS = 200, ABANDONED_MS = 3000 };

struct FlFileWatch {
    GPtrArray *folders; // Folder
    GHashTable *added;  // files that were added, a set
    GHashTable *open;   // path of a file that is being written -> gint64 *: the last event
    gint64 last_us;     // of the last event; 0: none
    char *last;         // the name of its file
    atomic_bool changed;
};

typedef struct Folder {
    FlFileWatch *watch;
    GFileMonitor *monitor;
    GPatternSpec *names; // of files that are read
} Folder;

static void folder_free(void *data)
{
    Folder *folder = data;
    g_file_monitor_cancel(folder->monitor);
    g_object_unref(folder->monitor);
    g_pattern_spec_free(folder->names);
    g_free(folder);
}

static gint64 *new_time(void)
{
    gint64 *time = g_new(gint64, 1);
    *time = g_get_monotonic_time();
    return time;
}

/* A file is open from its first change until it is closed, moved or gone. */
static void take_event(const Folder *folder, GFile *file, bool opens)
{
    g_autofree char *name = file ? g_file_get_basename(file) : NULL;
    if (!name || !g_pattern_spec_match_string(folder->names, name))
        return;
    FlFileWatch *watch = folder->watch;
    char *path = g_file_get_path(file);
    if (opens)
        g_hash_table_insert(watch->open, path, new_time());
    else {
        g_hash_table_remove(watch->open, path);
        g_free(path);
    }
    g_free(watch->last);
    watch->last = g_steal_pointer(&name);
    watch->last_us = g_get_monotonic_time();
    atomic_store(&watch->changed, true);
}

static void on_event(GFileMonitor *monitor, GFile *file, GFile *other, GFileMonitorEvent event,
                     void *data)
{
    if (event == G_FILE_MONITOR_EVENT_ATTRIBUTE_CHANGED)
        return; // touched or read
    take_event(data, file,
               event == G_FILE_MONITOR_EVENT_CREATED || event == G_FILE_MONITOR_EVENT_CHANGED);
    if (event ==
        G_FILE_MONITOR_EVENT_RENAMED) // what is moved in or out has its other name elsewhere
        take_event(data, other, false);
}

/* A folder that is not there is left out; the render says if it is missing. */
static void add_folder(FlFileWatch *watch, const char *path, const char *names)
{
    g_autoptr(GFile) file = g_file_new_for_path(path);
    GFileMonitor *monitor =
        g_file_test(path, G_FILE_TEST_IS_DIR)
            ? g_file_monitor_directory(file, G_FILE_MONITOR_WATCH_MOVES, NULL, NULL)
            : NULL;
    if (!monitor)
        return;
    Folder *folder = g_new(Folder, 1);
    *folder = (Folder){watch, monitor, g_pattern_spec_new(names)};
    g_file_monitor_set_rate_limit(monitor, TICK_MS);
    g_signal_connect(monitor, "changed", G_CALLBACK(on_event), folder);
    g_ptr_array_add(watch->folders, folder);
}

/* A file, or all that a pattern of a frame's number and {region} may name; NULL: none. */
static void add_files(FlFileWatch *watch, const char *pattern)
{
    if (!pattern)
        return;
    g_autofree char *folder = g_path_get_dirname(pattern);
    g_autofree char *name = g_path_get_basename(pattern);
    g_autoptr(GRegex) parts = g_regex_new("%[0-9]*d|#+|\\{region\\}", 0, 0, NULL);
    g_autofree char *names = g_regex_replace_literal(parts, name, -1, 0, "*", 0, NULL);
    add_folder(watch, folder, names ? names : "*");
}

/* Drawings and style sheets beside them; new frames appear in the same folder. */
static void add_input(FlFileWatch *watch, const char *input)
{
    static const char *const drawings[] = {"*.svg", "*.svgz", "*.css"};
    g_autofree char *folder =
        g_file_test(input, G_FILE_TEST_IS_DIR) ? g_strdup(input) : g_path_get_dirname(input);
    for (size_t k = 0; k < G_N_ELEMENTS(drawings); k++)
        add_folder(watch, folder, drawings[k]);
}

void fl_file_watch_add(FlFileWatch *watch, const char *file)
{
    g_autofree char *folder = g_path_get_dirname(file), *name = g_path_get_basename(file);
    if (g_hash_table_add(watch->added, g_strdup(file)))
        add_folder(watch, folder, name);
}

void fl_file_watch_add_all(FlFileWatch *watch, const FlFileWatch *old)
{
    GHashTableIter at;
    gpointer file;
    g_hash_table_iter_init(&at, old->added);
    while (g_hash_table_iter_next(&at, &file, NULL))
        fl_file_watch_add(watch, file);
}

static void add_style(FlFileWatch *watch, const char *path)
{
    static const char *const parts[] = {FL_STYLE_PARTS};
    for (size_t k = 0; k < G_N_ELEMENTS(parts); k++) {
        g_autofree char *part = g_build_filename(path, parts[k], NULL);
        add_folder(watch, part, "*");
    }
}

/* What a config is read for: the files that it names, relative to its own folder. */
typedef struct ConfigFiles {
    FlFileWatch *watch;
    const char *folder;
} ConfigFiles;

static char *add_entry(const char *section, const char *key, const char *value, void *data)
{
    const ConfigFiles *files = data;
    const FlOption *option = fl_option_find(FL_SCOPE_RENDER, key);
    g_autofree char *path = g_canonicalize_filename(value, files->folder);
    (void)section;
    if (fl_option_names_style(key))
        add_style(files->watch, path);
    else if (option && option->type == FL_OPTION_GROUND)
        add_files(files->watch, path);
    return NULL;
}

static void add_config_files(FlFileWatch *watch, const char *config)
{
    g_autofree char *text = NULL;
    if (!config || !g_file_get_contents(config, &text, NULL, NULL))
        return;
    g_autofree char *named_folder = g_path_get_dirname(config);
    g_autofree char *folder = g_canonicalize_filename(named_folder, NULL);
    ConfigFiles files = {watch, folder};
    g_free(fl_config_edit_map(text, add_entry, &files));
}

FlFileWatch *fl_file_watch_new(const FlRenderOptions *options)
{
    FlFileWatch *watch = g_new0(FlFileWatch, 1);
    watch->folders = g_ptr_array_new_with_free_func(folder_free);
    watch->open = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    watch->added = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    watch->last = g_strdup("");
    for (const char *const *input = options->inputs; *input; input++)
        add_input(watch, *input);
    add_files(watch, options->config);
    add_files(watch, options->background);
    add_files(watch, options->paper);
    add_files(watch, options->flow);
    add_files(watch, options->merge ? options->paint : NULL);
    add_config_files(watch, options->config);
    for (size_t k = 0; k < options->n_settings; k++)
        if (fl_option_names_style(options->settings[k].name))
            add_style(watch, options->settings[k].value);
    g_autoptr(GPtrArray) styles = fl_style_list();
    for (guint k = 0; k < styles->len; k++)
        add_style(watch, ((const FlStyleEntry *)styles->pdata[k])->path);
    return watch;
}

bool fl_file_watch_changed(FlFileWatch *watch)
{
    while (g_main_context_iteration(NULL, FALSE))
        continue;
    return fl_file_watch_has_changed(watch);
}

bool fl_file_watch_has_changed(const FlFileWatch *watch)
{
    return atomic_load(&watch->changed);
}

static gboolean on_tick(void *data)
{
    return G_SOURCE_CONTINUE; // the loop looks
}

/* The writer that opened the file no longer writes to it, or was killed. */
static gboolean is_abandoned(void *path, void *time, void *data)
{
    return g_get_monotonic_time() - *(gint64 *)time > (gint64)ABANDONED_MS * 1000;
}

bool fl_file_watch_has_settled(FlFileWatch *watch)
{
    g_hash_table_foreach_remove(watch->open, is_abandoned, NULL);
    return watch->last_us && g_hash_table_size(watch->open) == 0 &&
           g_get_monotonic_time() - watch->last_us > (gint64)SETTLE_MS * 1000;
}

bool fl_file_watch_wait(FlFileWatch *watch, const volatile sig_atomic_t *stop)
{
    const guint tick = g_timeout_add(TICK_MS, on_tick, NULL);
    while (!*stop && !fl_file_watch_has_settled(watch))
        g_main_context_iteration(NULL, TRUE);
    g_source_remove(tick);
    return !*stop;
}

const char *fl_file_watch_last(const FlFileWatch *watch)
{
    return watch->last;
}

void fl_file_watch_free(FlFileWatch *watch)
{
    if (!watch)
        return;
    g_ptr_array_unref(watch->folders);
    g_hash_table_unref(watch->added);
    g_hash_table_unref(watch->open);
    g_free(watch->last);
    g_free(watch);
}
