#include "io/atomic_file.h"

#include "base/error.h"
#include "io/provenance.h"
#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <stdbool.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#define MODE 0666 // less the umask

void fl_output_error(GError **error, const char *path, int errno_value)
{
    fl_fail(error, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path, g_strerror(errno_value));
}

/** Makes the folder and checks that the name is free. */
static bool prepare(FlAtomicFile *file, const char *path, bool overwrite, GError **error)
{
    g_autofree char *folder = g_path_get_dirname(path);
    *file = (FlAtomicFile){0};
    if (!overwrite && !fl_check_not_exists(path, error))
        return false;
    if (g_file_test(path, G_FILE_TEST_IS_DIR)) {
        fl_output_error(error, path, EISDIR);
        return false;
    }
    if (g_mkdir_with_parents(folder, 0777) != 0) {
        fl_output_error(error, folder, errno);
        return false;
    }
    file->path = g_strdup(path);
    file->overwrite = overwrite;
    return true;
}

/** ".NAME.part" beside the path: the same every time, so that the next process finds a leftover. */
static char *hidden_name(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path), *base = g_path_get_basename(path);
    g_autofree char *name = g_strdup_printf(".%s.part", base);
    return g_build_filename(folder, name, NULL);
}

/**
 * Opens a new locked file of the hidden name. Returns: -1 on failure; an error is set if another
 * process holds the lock. Replaces a leftover instead of reusing it: a child of the killed process
 * may still write there.
 */
static int open_hidden(FlAtomicFile *file, GError **error)
{
    file->temporary = hidden_name(file->path);
    const int left = fl_lock_take(file->temporary, file->path, error);
    if (left < 0)
        return -1;
    g_unlink(file->temporary);
    close(left);
    return fl_lock_take(file->temporary, file->path, error);
}

bool fl_atomic_open(FlAtomicFile *file, const char *path, bool overwrite, GError **error)
{
    GError *conflict = NULL;
    if (!prepare(file, path, overwrite, error))
        return false;
    const int fd = open_hidden(file, &conflict);
    if (fd >= 0) {
        file->stream = fdopen(fd, "wb");
        return true;
    }
    if (conflict)
        g_propagate_error(error, conflict);
    else
        fl_output_error(error, file->path, errno);
    g_clear_pointer(&file->temporary, g_free); // it belongs to the other process
    fl_atomic_clear(file);
    return false;
}

static bool sync_path(const char *path, int flags)
{
    const int fd = open(path, flags | O_CLOEXEC);
    const bool synced = fd >= 0 && fsync(fd) == 0;
    if (fd >= 0)
        close(fd);
    return synced;
}

static bool sync_file(FlAtomicFile *file)
{
    return fflush(file->stream) == 0 && fsync(fileno(file->stream)) == 0;
}

/** Renames without replacing; where the file system cannot, checks first. */
static bool rename_new(const char *from, const char *to)
{
#ifdef RENAME_NOREPLACE
    if (renameat2(AT_FDCWD, from, AT_FDCWD, to, RENAME_NOREPLACE) == 0)
        return true;
    if (errno != EINVAL && errno != ENOSYS)
        return false;
#endif
    if (g_file_test(to, G_FILE_TEST_EXISTS)) {
        errno = EEXIST;
        return false;
    }
    return rename(from, to) == 0;
}

bool fl_atomic_commit(FlAtomicFile *file, GError **error)
{
    if (!sync_file(file) || (file->overwrite ? rename(file->temporary, file->path) != 0
                                             : !rename_new(file->temporary, file->path))) {
        if (errno == EEXIST)
            fl_exists_error(error, file->path);
        else
            fl_output_error(error, file->path, errno);
        return false;
    }
    g_clear_pointer(&file->temporary, g_free);
    g_autofree char *folder = g_path_get_dirname(file->path);
    sync_path(folder, O_RDONLY | O_DIRECTORY); // makes the name durable; not every system can
    return true;
}

bool fl_atomic_seal(FlAtomicFile *file, const char *mark, GError **error)
{
    if (fflush(file->stream) == 0 && fl_mark_seal(fileno(file->stream), mark))
        return fl_atomic_commit(file, error);
    fl_output_error(error, file->path, errno);
    return false;
}

void fl_atomic_clear(FlAtomicFile *file)
{
    if (file->temporary)
        g_unlink(file->temporary); // while still locked: afterwards it may be another process's
    if (file->stream)
        fclose(file->stream);
    g_free(file->temporary);
    g_free(file->path);
    *file = (FlAtomicFile){0};
}

/* ---- locks ----------------------------------------------------------------------------------- */

/* The previous owner of the lock may have removed the name meanwhile. */
static bool still_named(int fd, const char *path)
{
    struct stat own, named;
    return fstat(fd, &own) == 0 && stat(path, &named) == 0 && own.st_ino == named.st_ino &&
           own.st_dev == named.st_dev;
}

static int open_or_make(const char *path, bool folder)
{
    const int flags = O_CREAT | O_RDWR | O_NOFOLLOW | O_CLOEXEC;
    int fd = folder ? -1 : open(path, flags, 0666);
    if (fd < 0 && !folder && errno == ELOOP && unlink(path) == 0) // a link is replaced
        fd = open(path, flags, 0666);
    if (!folder)
        return fd;
    if (mkdir(path, 0777) != 0 && errno != EEXIST)
        return -1;
    return open(path, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
}

static int take(const char *path, bool folder, const char *what, GError **error)
{
    for (;;) {
        const int fd = open_or_make(path, folder);
        if (fd < 0)
            return -1;
        const bool locked = flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!locked && still_named(fd, path))
            return fd;
        close(fd);
        if (locked) {
            fl_fail(error, FL_ERROR_EXISTS, "%s: another run is writing it", what);
            return -1;
        }
    }
}

int fl_lock_take(const char *path, const char *what, GError **error)
{
    return take(path, false, what, error);
}

int fl_lock_take_folder(const char *path, const char *what, GError **error)
{
    return take(path, true, what, error);
}
