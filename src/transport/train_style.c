#include "io/child_process.h"
#include "style/find_style.h"
#include "transport/network.h"
#include "transport/style_ink.h"
#include "transport/tile.h"

#include <glib/gstdio.h>
#include <stdio.h>
#include <string.h>

#define SCRIPT "train_network.py" // beside the folders of styles
#define PATIENCE_S 3600

static char *find_script(GError **error)
{
    g_auto(GStrv) folders = fl_style_folders();
    for (int i = 0; folders[i]; i++) {
        g_autofree char *above = g_path_get_dirname(folders[i]);
        g_autofree char *path = g_build_filename(above, SCRIPT, NULL);
        if (g_file_test(path, G_FILE_TEST_IS_REGULAR))
            return g_steal_pointer(&path);
    }
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                SCRIPT ": not beside any folder of styles; expected it to be installed with them");
    return NULL;
}

/* The network sees flat ink that pools. */
static bool suits(const FlTransportStyle *wanted, const char *folder, GError **error)
{
    if (wanted->mode == FL_TRANSPORT_GATHER && wanted->density == FL_DENSITY_FLAT &&
        wanted->match == FL_MATCH_PATCHES)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                "%s: a network learns motion = gather, density = flat, match = patches only; "
                "expected these in the section [transport]",
                folder);
    return false;
}

/* A training under way. */
typedef struct Training {
    FlChild *child;
    FlTransportProgress progress; // or NULL
    void *data;
    int told; // the last step
} Training;

/* Tells the last line of the script, which writes one every 50 steps, once. Returns: whether to
 * stop. */
static bool tell(void *data)
{
    Training *training = data;
    int step, steps;
    if (!training->progress || !training->child)
        return false;
    g_autofree char *words = fl_child_stderr_tail(training->child);
    const char *line = g_strrstr(words, "step ");
    if (!line || sscanf(line, "step %d of %d", &step, &steps) != 2 || step == training->told)
        return false;
    const char *loss = strstr(line, "loss ");
    training->told = step;
    return !training->progress(training->data, step, steps,
                               loss ? (float)g_ascii_strtod(loss + strlen("loss "), NULL) : 0);
}

static bool train(const FlStyle *style, const FlTransportStyle *wanted, Training *training,
                  GError **error)
{
    g_autofree char *script = find_script(error);
    g_autofree float *density = script ? fl_style_ink(style, error) : NULL;
    g_autofree char *width = g_strdup_printf("%d", style->width);
    g_autofree char *height = g_strdup_printf("%d", style->height);
    char taper[G_ASCII_DTOSTR_BUF_SIZE];
    g_ascii_dtostr(taper, sizeof taper, (double)wanted->taper_px);
    g_autofree char *out = g_build_filename(style->path, FL_STYLE_NETWORK, NULL);
    const char *const arguments[] = {"python3", script, width, height, taper, out, NULL};
    const FlPatience patience = {PATIENCE_S, tell, training};
    if (!density)
        return false;
    g_autoptr(FlChild) child = fl_child_start(arguments, FL_CHILD_INPUT, -1, &patience, error);
    const size_t bytes = sizeof(float) * (size_t)style->width * (size_t)style->height;
    training->child = child;
    return child && fl_child_write(child, density, bytes, error) && fl_child_finish(child, error);
}

bool fl_style_network(const char *style_name, bool overwrite, FlTransportProgress progress,
                      void *data, GError **error)
{
    Training training = {.progress = progress, .data = data, .told = -1};
    g_autofree char *folder = fl_style_find(style_name, error);
    g_autoptr(FlStyle) style = folder ? fl_style_load(folder, error) : NULL;
    FlTransportStyle wanted;
    if (!style || !fl_transport_style_read(&wanted, folder, error) ||
        !suits(&wanted, folder, error))
        return false;
    if (!overwrite && fl_network_exists(folder)) {
        g_set_error(error, FL_ERROR, FL_ERROR_EXISTS,
                    "%s: has a " FL_STYLE_NETWORK " already; use ‘overwrite’", folder);
        return false;
    }
    return train(style, &wanted, &training, error);
}
