#include "base/file.h"

#include "base/error.h"
#include "base/limits.h"
#include <errno.h>
#include <fcntl.h>
#include <poll.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define BLOCK_BYTES 65536
#define TICK_MS 100

static bool cannot_read(const char *path, GError **error)
{
    return fl_fail(error, FL_ERROR_INPUT, "%s: cannot be read: %s", path, g_strerror(errno));
}

static bool is_regular(const struct stat *info, const char *path, FlError code, GError **error)
{
    if (S_ISREG(info->st_mode) || S_ISDIR(info->st_mode))
        return true;
    return fl_fail(error, code, "%s: it is a pipe or a device; expected a file", path);
}

bool fl_file_check(const char *path, FlError code, GError **error)
{
    struct stat info;
    return stat(path, &info) != 0 || is_regular(&info, path, code, error);
}

/** Waits until fd has data or ends. Returns: false with an error. */
static bool wait_for(int fd, const char *path, const FlFileWait *wait, GError **error)
{
    const gint64 end = g_get_monotonic_time() + fl_limit(FL_LIMIT_SECONDS) * G_USEC_PER_SEC;
    struct pollfd ready = {.fd = fd, .events = POLLIN};
    while (poll(&ready, 1, TICK_MS) <= 0) {
        if (wait->stopped && wait->stopped(wait->data))
            return fl_fail(error, FL_ERROR_INTERRUPTED, "%s: interrupted", path);
        if (g_get_monotonic_time() > end)
            return fl_fail(error, FL_ERROR_LIMIT,
                           "%s: nothing was written to it for %d s; use ‘limit’ seconds=N to wait "
                           "longer",
                           path, (int)fl_limit(FL_LIMIT_SECONDS));
    }
    return true;
}

/** Reads to the end or one byte more than `most`; without `wait` only what never makes it wait. */
static bool read_all(int fd, const char *path, size_t most, const FlFileWait *wait, GByteArray *all,
                     GError **error)
{
    guint8 block[BLOCK_BYTES];
    while (all->len <= most) {
        if (wait && !wait_for(fd, path, wait, error))
            return false;
        const ssize_t n = read(fd, block, MIN(sizeof block, most + 1 - all->len));
        if (n < 0 && (errno == EAGAIN || errno == EINTR))
            continue;
        if (n < 0)
            return cannot_read(path, error);
        if (n == 0)
            return true;
        g_byte_array_append(all, block, (guint)n);
    }
    return true;
}

bool fl_file_read(const char *path, size_t most, const FlFileWait *wait, char **data, size_t *bytes,
                  GError **error)
{
    struct stat info;
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    if (fd < 0)
        return cannot_read(path, error);
    g_autoptr(GByteArray) all = g_byte_array_new();
    const bool good =
        (wait || (fstat(fd, &info) == 0 && is_regular(&info, path, FL_ERROR_INPUT, error))) &&
        read_all(fd, path, most, wait, all, error);
    close(fd);
    if (!good)
        return false;
    *bytes = all->len;
    g_byte_array_append(all, (const guint8 *)"", 1);
    *data = (char *)g_byte_array_free(g_steal_pointer(&all), FALSE);
    return true;
}

int fl_by_name(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

GPtrArray *fl_folder_names(const char *folder, GError **error)
{
    g_autoptr(GError) reason = NULL;
    g_autoptr(GDir) dir = g_dir_open(folder, 0, &reason);
    if (!dir)
        return fl_none(error, FL_ERROR_INPUT, "%s", reason->message);
    GPtrArray *names = g_ptr_array_new_with_free_func(g_free);
    for (const char *name; (name = g_dir_read_name(dir));)
        g_ptr_array_add(names, g_strdup(name));
    g_ptr_array_sort(names, fl_by_name);
    return names;
}

int fl_open_regular(const char *path, int flags, size_t *bytes)
{
    struct stat info;
    const int fd = open(path, O_RDONLY | O_NONBLOCK | O_NOCTTY | O_CLOEXEC | flags);
    if (fd >= 0 && fstat(fd, &info) == 0 && S_ISREG(info.st_mode) && info.st_size >= 0) {
        *bytes = (size_t)info.st_size;
        return fd;
    }
    if (fd >= 0)
        close(fd);
    return -1;
}

bool fl_write_all(int fd, const void *data, size_t bytes)
{
    for (const uint8_t *at = data; bytes > 0;) {
        const ssize_t n = write(fd, at, bytes);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        at += n, bytes -= (size_t)n;
    }
    return true;
}

bool fl_pwrite_all(int fd, const void *data, size_t bytes, int64_t offset)
{
    for (const uint8_t *at = data; bytes > 0;) {
        const ssize_t n = pwrite(fd, at, bytes, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n <= 0)
            return false;
        at += n, offset += n, bytes -= (size_t)n;
    }
    return true;
}

bool fl_pread_all(int fd, void *data, size_t bytes, int64_t offset)
{
    for (uint8_t *at = data; bytes > 0;) {
        const ssize_t n = pread(fd, at, bytes, offset);
        if (n < 0 && errno == EINTR)
            continue;
        if (n == 0)
            errno = 0;
        if (n <= 0)
            return false;
        at += n, offset += n, bytes -= (size_t)n;
    }
    return true;
}
