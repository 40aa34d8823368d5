#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#define BLOCK_BYTES 65536

static bool cannot_read(const char *path, GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be read: %s", path, g_strerror(errno));
    return false;
}

static bool is_regular(const struct stat *info, const char *path, FlError code, GError **error)
{
    if (S_ISREG(info->st_mode) || S_ISDIR(info->st_mode))
        return true;
    g_set_error(error, FL_ERROR, (gint)code, "%s: it is a pipe or a device; expected a file", path);
    return false;
}

bool fl_file_check(const char *path, FlError code, GError **error)
{
    struct stat info;
    return stat(path, &info) != 0 || is_regular(&info, path, code, error);
}

bool fl_file_read(const char *path, size_t most, char **data, size_t *bytes, GError **error)
{
    struct stat info;
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0)
        return cannot_read(path, error);
    g_autoptr(GByteArray) all = g_byte_array_new();
    bool good = fstat(fd, &info) == 0 && is_regular(&info, path, FL_ERROR_INPUT, error);
    guint8 block[BLOCK_BYTES];
    ssize_t n = good ? 1 : 0;
    while (n > 0 && all->len <= most) {
        n = read(fd, block, MIN(sizeof block, most + 1 - all->len));
        if (n < 0)
            good = cannot_read(path, error);
        else
            g_byte_array_append(all, block, (guint)n);
    }
    close(fd);
    if (!good)
        return false;
    *bytes = all->len;
    g_byte_array_append(all, (const guint8 *)"", 1);
    *data = (char *)g_byte_array_free(g_steal_pointer(&all), FALSE);
    return true;
}
