#include "style/write_style.h"

#include "base/error.h"
#include "base/file.h"
#include "io/atomic_file.h"
#include "io/png.h"
#include "style/manifest.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <unistd.h>

/* The parts of a style's folder; the flow of another recording must not stay behind. */
static const char *const parts[] = {"frames", "masks", "flow", "style.ini"};

bool fl_style_may_write(const char *folder, bool overwrite, GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(parts) && !overwrite; i++) {
        g_autofree char *path = g_build_filename(folder, parts[i], NULL);
        if (!fl_check_not_exists(path, error))
            return false;
    }
    if (!g_file_test(folder, G_FILE_TEST_EXISTS) || g_file_test(folder, G_FILE_TEST_IS_DIR))
        return true;
    return fl_fail(error, FL_ERROR_OUTPUT, "%s: is a file: expected a folder", folder);
}

static bool failed(GError **error, const char *path, const char *what)
{
    return fl_fail(error, FL_ERROR_OUTPUT, "%s: %s: %s", path, what, g_strerror(errno));
}

static bool write_planes(const char *folder, const uint8_t *data, const FlStyle *style,
                         int channels, GError **error)
{
    if (g_mkdir(folder, 0755) != 0)
        return failed(error, folder, "cannot be made");
    const size_t bytes = (size_t)style->width * style->height * channels;
    GError *first = NULL;
#pragma omp parallel for schedule(dynamic, 1)
    for (int i = 0; i < style->n_frames; i++) {
        GError *failure = NULL;
        g_autofree char *name = g_strdup_printf("%04d.png", i + 1);
        g_autofree char *path = g_build_filename(folder, name, NULL);
        if (!fl_png_write(path, data + i * bytes, style->width, style->height, channels, &failure))
            fl_parallel_error_keep(&first, failure);
    }
    return fl_parallel_error_propagate(error, first);
}

static bool write_parts(const FlStyle *style, const char *folder, GError **error)
{
    g_autofree char *frames = g_build_filename(folder, "frames", NULL);
    g_autofree char *masks = g_build_filename(folder, "masks", NULL);
    g_autofree char *manifest = g_build_filename(folder, "style.ini", NULL);
    g_autofree char *text = fl_manifest_text(style);
    g_autoptr(GError) below = NULL;
    if (!write_planes(frames, style->rgb, style, 3, error) ||
        !write_planes(masks, style->mask, style, 1, error))
        return false;
    if (g_file_set_contents(manifest, text, -1, &below))
        return true;
    return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", manifest, below->message);
}

/* Puts each finished part in the place of the old one. */
static bool move_parts(const char *from, const char *to, GError **error)
{
    if (g_mkdir_with_parents(to, 0755) != 0)
        return failed(error, to, "cannot be made");
    for (size_t i = 0; i < G_N_ELEMENTS(parts); i++) {
        g_autofree char *source = g_build_filename(from, parts[i], NULL);
        g_autofree char *target = g_build_filename(to, parts[i], NULL);
        if (!fl_file_remove(target, error))
            return false;
        if (g_file_test(source, G_FILE_TEST_EXISTS) && g_rename(source, target) != 0)
            return failed(error, target, "cannot be replaced");
    }
    return true;
}

static bool remove_parts(const char *folder, GError **error)
{
    for (size_t i = 0; i < G_N_ELEMENTS(parts); i++) {
        g_autofree char *path = g_build_filename(folder, parts[i], NULL);
        if (!fl_file_remove(path, error))
            return false;
    }
    return true;
}

/* ".NAME.part" beside a folder: the same in each run, which removes the rest of a killed run. */
static char *hidden_name(const char *folder)
{
    g_autofree char *parent = g_path_get_dirname(folder), *base = g_path_get_basename(folder);
    g_autofree char *name = g_strdup_printf(".%s.part", base);
    return g_build_filename(parent, name, NULL);
}

bool fl_style_write(const FlStyle *style, const char *folder, bool overwrite, GError **error)
{
    g_autofree char *absolute = g_canonicalize_filename(folder, NULL);
    g_autofree char *parent = g_path_get_dirname(absolute);
    g_autofree char *beside = hidden_name(absolute);
    GError *lock_error = NULL;
    if (!fl_style_may_write(folder, overwrite, error))
        return false;
    if (g_mkdir_with_parents(parent, 0755) != 0)
        return failed(error, parent, "cannot be made");
    const int lock = fl_lock_take_folder(beside, folder, &lock_error);
    if (lock_error)
        g_propagate_error(error, lock_error);
    else if (lock < 0)
        failed(error, parent, "cannot be written to");
    if (lock < 0)
        return false;
    const bool done = remove_parts(beside, error) && write_parts(style, beside, error) &&
                      move_parts(beside, absolute, error);
    remove_parts(beside, NULL);
    g_rmdir(beside);
    close(lock);
    return done;
}
