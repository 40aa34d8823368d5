#include "file_watch.h"

#include "base/error.h"
#include <gio/gio.h>
#include <stdatomic.h>
#include <string.h>

enum { TICK_MS = 50, SETTLE_MS = 200, ABANDONED_MS = 3000 };

struct FlFileWatch {
    GHashTable *folders; // char * -> Folder *
    GHashTable *added;   // files that were added, a set
    GHashTable *open;    // path of a file that is being written -> gint64 *: the last event
    gint64 last_us;      // of the last event; 0: before the first
    char *last;          // the name of its file
    atomic_bool changed;
};

typedef struct Folder {
    FlFileWatch *watch;
    GFile *file;
    GFileMonitor *monitor; // NULL: it cannot be watched
    GHashTable *names;     // of files that are read, a set
    GPtrArray *patterns;   // GPatternSpec: of more of them
} Folder;

static void folder_free(void *data)
{
    Folder *folder = data;
    if (folder->monitor)
        g_file_monitor_cancel(folder->monitor);
    g_clear_object(&folder->monitor);
    g_object_unref(folder->file);
    g_hash_table_unref(folder->names);
    g_ptr_array_unref(folder->patterns);
    g_free(folder);
}

static bool is_read(const Folder *folder, const char *name)
{
    bool found = g_hash_table_contains(folder->names, name);
    for (guint k = 0; k < folder->patterns->len && !found; k++)
        found = g_pattern_spec_match_string(folder->patterns->pdata[k], name);
    return found;
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
    const bool whole = file && g_file_equal(file, folder->file); // is there again, or gone
    if (!name || (!whole && !is_read(folder, name)))
        return;
    FlFileWatch *watch = folder->watch;
    char *path = g_file_get_path(file);
    if (opens && !whole)
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
        G_FILE_MONITOR_EVENT_RENAMED) // a file moved in or out has its other name in another folder
        take_event(data, other, false);
}

/* The folder of that path, which is watched from now on, and looked for while it is gone. */
static Folder *folder_at(FlFileWatch *watch, const char *path)
{
    Folder *folder = g_hash_table_lookup(watch->folders, path);
    if (folder)
        return folder;
    folder = g_new0(Folder, 1);
    folder->watch = watch;
    folder->file = g_file_new_for_path(path);
    folder->names = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    folder->patterns = g_ptr_array_new_with_free_func((GDestroyNotify)g_pattern_spec_free);
    g_hash_table_insert(watch->folders, g_strdup(path), folder);
    folder->monitor =
        g_file_monitor_directory(folder->file, G_FILE_MONITOR_WATCH_MOVES, NULL, NULL);
    if (!folder->monitor)
        return folder;
    g_file_monitor_set_rate_limit(folder->monitor, TICK_MS);
    g_signal_connect(folder->monitor, "changed", G_CALLBACK(on_event), folder);
    return folder;
}

static void add_pattern(FlFileWatch *watch, const char *folder, const char *names)
{
    g_ptr_array_add(folder_at(watch, folder)->patterns, g_pattern_spec_new(names));
}

/* Drawings and style sheets beside them; new frames appear in the same folder. An input that is
 * gone may come back as a folder. */
static void add_input(FlFileWatch *watch, const char *input)
{
    static const char *const drawings[] = {"*.svg", "*.svgz", "*.css"};
    g_autofree char *beside = g_path_get_dirname(input);
    for (size_t k = 0; k < G_N_ELEMENTS(drawings); k++) {
        if (!g_file_test(input, G_FILE_TEST_IS_DIR))
            add_pattern(watch, beside, drawings[k]);
        if (!g_file_test(input, G_FILE_TEST_IS_REGULAR))
            add_pattern(watch, input, drawings[k]);
    }
}

/* A glob of the files that a name such as map_%04d.png or map_####.png stands for, to be freed;
 * NULL: it has no number. */
static char *all_of(const char *name)
{
    g_auto(GStrv) parts = g_regex_split_simple("%[0-9]*d|#+", name, 0, 0);
    return parts[1] || strpbrk(name, "*?") ? g_strjoinv("*", parts) : NULL;
}

void fl_file_watch_add(FlFileWatch *watch, const char *path)
{
    if (!g_hash_table_add(watch->added, g_strdup(path)))
        return;
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *base = g_path_get_basename(path), *names = all_of(base);
    if (g_file_test(path, G_FILE_TEST_IS_DIR))
        add_pattern(watch, path, "*");
    else if (names)
        add_pattern(watch, folder, names);
    else
        g_hash_table_add(folder_at(watch, folder)->names, g_steal_pointer(&base));
}

void fl_file_watch_add_all(FlFileWatch *watch, const FlFileWatch *old)
{
    GHashTableIter at;
    gpointer file;
    g_hash_table_iter_init(&at, old->added);
    while (g_hash_table_iter_next(&at, &file, NULL))
        fl_file_watch_add(watch, file);
}

bool fl_file_watch_works(GError **error)
{
    g_autoptr(GFile) any = g_file_new_for_path("/");
    g_autoptr(GFileMonitor) monitor = g_file_monitor_directory(any, 0, NULL, NULL);
    if (!monitor)
        fl_fail(error, FL_ERROR_NO_MEMORY,
                "changed files cannot be noticed here: there is no inotify, or other programs "
                "use all of it (see fs.inotify.max_user_instances)");
    return monitor;
}

FlFileWatch *fl_file_watch_new(const char *const *inputs, const char *config)
{
    FlFileWatch *watch = g_new0(FlFileWatch, 1);
    watch->folders = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, folder_free);
    watch->open = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    watch->added = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    watch->last = g_strdup("");
    for (const char *const *input = inputs; *input; input++)
        add_input(watch, *input);
    if (config)
        fl_file_watch_add(watch, config);
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

/* Returns: true if the file's writer has paused for long, or was killed. */
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
    g_hash_table_unref(watch->folders);
    g_hash_table_unref(watch->added);
    g_hash_table_unref(watch->open);
    g_free(watch->last);
    g_free(watch);
}
