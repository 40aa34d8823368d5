#include "live_drop.h"

#include <gio/gio.h>
#include <glib/gstdio.h>
#include <signal.h>
#include <string.h>

enum { MOST_FILES = 10000, MOST_BYTES = 512 << 20 };

struct FlLiveDrop {
    char *folder;
    GPtrArray *files; // char *
    gsize bytes;
    char *inputs[2];
    struct Making *making; // NULL: no frames are being made
};

/* Frames that are being made. */
typedef struct Making {
    FlLiveDrop *drop; // NULL: freed
    GSubprocess *process;
    void (*ready)(const GError *error, void *data);
    void *data;
} Making;

void fl_live_drop_begin(FlLiveDrop **drop)
{
    fl_live_drop_free(*drop);
    *drop = g_new0(FlLiveDrop, 1);
    (*drop)->files = g_ptr_array_new_with_free_func(g_free);
    (*drop)->folder = g_dir_make_tmp("fluidy-svg-XXXXXX", NULL);
}

static bool is_lottie(const char *name)
{
    return g_str_has_suffix(name, ".json") || g_str_has_suffix(name, ".lottie");
}

static bool is_name(const char *name)
{
    const bool known = g_str_has_suffix(name, ".svg") || g_str_has_suffix(name, ".svgz") ||
                       g_str_has_suffix(name, ".css") || is_lottie(name);
    return known && *name != '.' && !strchr(name, '/') && strlen(name) < 200 &&
           g_utf8_validate(name, -1, NULL);
}

bool fl_live_drop_add(FlLiveDrop *drop, const char *name, const char *data, gsize bytes,
                      GError **error)
{
    if (!is_name(name)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: expected drawings, .svg or .svgz, and their style sheets, .css, or an "
                    "animation, .json or .lottie",
                    name);
        return false;
    }
    if (!drop || !drop->folder) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: there is no folder for it", name);
        return false;
    }
    drop->bytes += bytes;
    if (drop->bytes > MOST_BYTES || drop->files->len >= MOST_FILES) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT,
                    "%s: more than %d files or %d MiB were dropped; give the program the folder",
                    name, MOST_FILES, MOST_BYTES >> 20);
        return false;
    }
    char *file = g_build_filename(drop->folder, name, NULL);
    g_ptr_array_add(drop->files, file);
    drop->inputs[0] = drop->files->len > 1 ? drop->folder : file;
    return g_file_set_contents(file, data ? data : "", (gssize)bytes, error);
}

/* ---- frames of other formats ------------------------------------------------------------------
 */

static void on_made(GObject *process, GAsyncResult *result, void *data)
{
    Making *making = data;
    g_autoptr(GError) error = NULL;
    g_autofree char *said = NULL;
    const bool ended =
        g_subprocess_communicate_utf8_finish(making->process, result, NULL, &said, &error);
    if (ended && !(making->drop && g_subprocess_get_successful(making->process)))
        g_set_error(&error, FL_ERROR, FL_ERROR_INPUT, "%s", *said ? g_strstrip(said) : "stopped");
    if (making->drop)
        making->drop->making = NULL;
    making->ready(error, making->data);
    g_object_unref(making->process);
    g_free(making);
}

static void make_frames(FlLiveDrop *drop, void (*ready)(const GError *error, void *data),
                        void *data)
{
    g_autoptr(GError) error = NULL;
    const char *file = drop->inputs[0];
    char *folder = g_strndup(file, (gsize)(strrchr(file, '.') - file));
    g_ptr_array_add(drop->files, folder);
    drop->inputs[0] = folder;
    GSubprocess *process =
        g_subprocess_new(G_SUBPROCESS_FLAGS_STDOUT_SILENCE | G_SUBPROCESS_FLAGS_STDERR_PIPE, &error,
                         "fluidy-frames", file, "-o", folder, NULL);
    if (!process) {
        g_prefix_error(&error, "frames of it are made by fluidy-frames; see fluidy-exports(7): ");
        ready(error, data);
        return;
    }
    drop->making = g_new(Making, 1);
    *drop->making = (Making){drop, process, ready, data};
    g_subprocess_communicate_utf8_async(process, NULL, NULL, on_made, drop->making);
}

void fl_live_drop_end(FlLiveDrop *drop, void (*ready)(const GError *error, void *data), void *data)
{
    if (drop->files->len == 1 && is_lottie(drop->files->pdata[0]))
        make_frames(drop, ready, data);
    else
        ready(NULL, data);
}

static void remove_files(const char *folder)
{
    g_autoptr(GDir) files = g_dir_open(folder, 0, NULL);
    for (const char *name; files && (name = g_dir_read_name(files));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        if (g_file_test(path, G_FILE_TEST_IS_DIR) && !g_file_test(path, G_FILE_TEST_IS_SYMLINK))
            remove_files(path);
        g_unlink(path);
    }
    g_rmdir(folder);
}

const char *const *fl_live_drop_inputs(const FlLiveDrop *drop)
{
    return (const char *const *)drop->inputs;
}

void fl_live_drop_free(FlLiveDrop *drop)
{
    if (!drop)
        return;
    if (drop->making) {
        drop->making->drop = NULL;
        g_subprocess_send_signal(drop->making->process, SIGTERM);
    }
    if (drop->folder)
        remove_files(drop->folder);
    g_ptr_array_unref(drop->files);
    g_free(drop->folder);
    g_free(drop);
}
