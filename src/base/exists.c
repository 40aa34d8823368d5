#include "base/exists.h"

void fl_exists_error(GError **error, const char *path)
{
    g_set_error(error, FL_ERROR, FL_ERROR_EXISTS,
                "%s: already exists; use ‘overwrite’ to replace it", path);
}

bool fl_check_not_exists(const char *path, GError **error)
{
    if (!g_file_test(path, G_FILE_TEST_EXISTS))
        return true;
    fl_exists_error(error, path);
    return false;
}
