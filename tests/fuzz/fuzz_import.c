/*
 * A recording that becomes a style: a line of letters that say how, and PNG pictures behind it. The
 * style is read again and checked.
 */
#include "folder.h"
#include "fuzz.h"
#include "style/style_folder.h"
#include <fluidy/limits.h>
#include <fluidy/style.h>
#include <glib/gstdio.h>
#include <math.h>
#include <string.h>

#define MOST_FRAMES 5

int LLVMFuzzerInitialize(int *n, char ***arguments);

int LLVMFuzzerInitialize(int *n, char ***arguments)
{
    return fl_limit_set("image=1", NULL) && fl_limit_set("style=1", NULL) ? 0 : 1;
}

/** "fsw" for the three switches, "c1234" for a crop, and numbers for what is one. */
static void choose(const char *line, FlStyleImport *how)
{
    how->flatten = !strchr(line, 'f');
    how->stabilise = !strchr(line, 's');
    how->whole = strchr(line, 'w') != NULL;
    const char *crop = strchr(line, 'c'), *scale = strchr(line, 'x'), *border = strchr(line, 'b');
    for (int k = 0; crop && k < 4 && crop[1 + k]; k++)
        how->crop[k] = crop[1 + k] - '0';
    how->scale = scale ? g_ascii_strtod(scale + 1, NULL) : 0;
    how->border_px = border ? g_ascii_strtod(border + 1, NULL) : 0;
    how->paper = strchr(line, '#');
}

static void check_style(const char *folder)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(FlStyle) style = fl_style_load(folder, &error);
    g_assert_no_error(error);
    g_assert_true(isfinite(style->border_px) && style->border_px > 0 && style->fps > 0);
    g_autoptr(FlStyleReport) report = fl_style_check(folder, NULL, false, &error);
    g_assert_no_error(error);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    g_autofree char *line = NULL;
    g_autofree char *source = g_build_filename(fuzz_folder(), "recording", NULL);
    g_autofree char *folder = g_build_filename(fuzz_folder(), "style", NULL);
    fuzz_empty(fuzz_folder(), 1);
    g_mkdir(source, 0777);
    FlStyleImport how = FL_STYLE_IMPORT_DEFAULTS;
    fuzz_write_pngs(data, size, source, MOST_FRAMES, &line);
    how.source = source, how.folder = folder;
    choose(line, &how);
    g_autoptr(GPtrArray) notes = g_ptr_array_new_with_free_func(g_free);
    g_autoptr(GError) error = NULL;
    const bool good = fl_style_import(&how, notes, &error);
    g_assert_true(good == (error == NULL));
    if (good)
        check_style(folder);
    return 0;
}
