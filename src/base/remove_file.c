#include "base/error.h"
#include "base/file.h"

#include <errno.h>
#include <glib/gstdio.h>

bool fl_file_remove(const char *path, GError **error)
{
    g_autoptr(GDir) dir =
        g_file_test(path, G_FILE_TEST_IS_SYMLINK) ? NULL : g_dir_open(path, 0, NULL);
    for (const char *name; dir && (name = g_dir_read_name(dir));) {
        g_autofree char *inner = g_build_filename(path, name, NULL);
        if (!fl_file_remove(inner, error))
            return false;
    }
    if (g_remove(path) == 0 || errno == ENOENT)
        return true;
    return fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be removed: %s", path, g_strerror(errno));
}
