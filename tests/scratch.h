/* A folder of small files for one test. */
#ifndef FLUIDY_TESTS_SCRATCH_H
#define FLUIDY_TESTS_SCRATCH_H

#include <glib.h>
#include <glib/gstdio.h>
#include <stdio.h>

/** Makes an empty folder; to be removed with scratch_remove(). */
static inline char *scratch_make(void)
{
    GError *error = NULL;
    char *folder = g_dir_make_tmp("fluidy-test-XXXXXX", &error);
    g_assert_no_error(error);
    return folder;
}

static inline void scratch_remove(char *folder)
{
    GDir *dir = g_dir_open(folder, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *path = g_build_filename(folder, name, NULL);
        g_unlink(path);
    }
    if (dir)
        g_dir_close(dir);
    g_rmdir(folder);
    g_free(folder);
}

typedef char Scratch;
G_DEFINE_AUTOPTR_CLEANUP_FUNC(Scratch, scratch_remove)

/** Writes a file into it. Returns: its path, to be freed. */
static inline char *scratch_write(const char *folder, const char *name, const char *text)
{
    char *path = g_build_filename(folder, name, NULL);
    g_assert_true(g_file_set_contents(path, text, -1, NULL));
    return path;
}

/** The same with an <svg> of 100 x 100 px around the text. */
static inline char *scratch_svg(const char *folder, const char *name, const char *content)
{
    g_autofree char *text =
        g_strdup_printf("<svg xmlns=\"http://www.w3.org/2000/svg\" "
                        "xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"100\" height=\"100\" "
                        "viewBox=\"0 0 100 100\">%s</svg>",
                        content);
    return scratch_write(folder, name, text);
}

/** Writes a file without waiting for the disk. GLib 2.74 would not cut off a longer file that is
 * there already (G_FILE_SET_CONTENTS_NONE). */
static inline void scratch_put(const char *path, const char *data, gsize bytes)
{
    FILE *file = fopen(path, "wb");
    g_assert_true(file && fwrite(data, 1, bytes, file) == bytes);
    fclose(file);
}

#endif
