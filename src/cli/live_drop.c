#include "live_drop.h"

#include <glib/gstdio.h>
#include <string.h>

enum { MOST_FILES = 10000, MOST_BYTES = 512 << 20 };

struct FlLiveDrop {
    char *folder;
    GPtrArray *files; // char *
    gsize bytes;
    char *inputs[2];
};

void fl_live_drop_begin(FlLiveDrop **drop)
{
    fl_live_drop_free(*drop);
    *drop = g_new0(FlLiveDrop, 1);
    (*drop)->files = g_ptr_array_new_with_free_func(g_free);
    (*drop)->folder = g_dir_make_tmp("fluidy-svg-XXXXXX", NULL);
}

static bool is_name(const char *name)
{
    static const char *const ends[] = {".svg", ".svgz", ".css"};
    bool known = false;
    for (size_t k = 0; k < G_N_ELEMENTS(ends); k++)
        known = known || g_str_has_suffix(name, ends[k]);
    return known && *name != '.' && !strchr(name, '/') && strlen(name) < 200 &&
           g_utf8_validate(name, -1, NULL);
}

bool fl_live_drop_add(FlLiveDrop *drop, const char *name, const char *data, gsize bytes,
                      GError **error)
{
    if (!is_name(name)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: expected drawings, .svg or .svgz, and their style sheets, .css", name);
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

const char *const *fl_live_drop_inputs(const FlLiveDrop *drop)
{
    return (const char *const *)drop->inputs;
}

void fl_live_drop_free(FlLiveDrop *drop)
{
    if (!drop)
        return;
    for (guint k = 0; k < drop->files->len; k++)
        g_unlink(drop->files->pdata[k]);
    if (drop->folder)
        g_rmdir(drop->folder);
    g_ptr_array_unref(drop->files);
    g_free(drop->folder);
    g_free(drop);
}
