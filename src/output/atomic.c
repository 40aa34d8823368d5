#include "output/atomic.h"

#include "output/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <glib/gstdio.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#define MODE 0666 // less the umask

void fl_output_error(GError **error, const char *path, int errno_value)
{
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                g_strerror(errno_value));
}

static void exists_error(GError **error, const char *path)
{
    g_set_error(error, FL_ERROR, FL_ERROR_EXISTS,
                "%s: exists already; expected a new name, or leave to overwrite", path);
}

/** Makes the folder and looks whether the name is free. */
static bool prepare(FlAtomic *file, const char *path, bool overwrite, GError **error)
{
    g_autofree char *folder = g_path_get_dirname(path);
    *file = (FlAtomic){0};
    if (!overwrite && g_file_test(path, G_FILE_TEST_EXISTS)) {
        exists_error(error, path);
        return false;
    }
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

/** A hidden name beside the path. */
static char *temporary_name(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path);
    g_autofree char *name = g_strdup_printf(".fluidy-%08x%08x", g_random_int(), g_random_int());
    return g_build_filename(folder, name, NULL);
}

/** A descriptor of a file without a name in the path's folder, or -1. */
static int open_nameless(const char *path)
{
#ifdef O_TMPFILE
    g_autofree char *folder = g_path_get_dirname(path);
    return open(folder, O_TMPFILE | O_WRONLY | O_CLOEXEC, MODE);
#else
    return -1;
#endif
}

static int open_named(FlAtomic *file)
{
    file->temporary = temporary_name(file->path);
    return open(file->temporary, O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, MODE);
}

/** Sets the error, forgets the file and returns false. */
static bool give_up(FlAtomic *file, int errno_value, GError **error)
{
    fl_output_error(error, file->path, errno_value);
    g_clear_pointer(&file->temporary, g_free);
    g_clear_pointer(&file->path, g_free);
    return false;
}

bool fl_atomic_open(FlAtomic *file, const char *path, bool overwrite, GError **error)
{
    if (!prepare(file, path, overwrite, error))
        return false;
    int fd = open_nameless(path);
    if (fd < 0)
        fd = open_named(file);
    if (fd < 0)
        return give_up(file, errno, error);
    file->stream = fdopen(fd, "wb");
    return true;
}

/** ".NAME.part" beside the path. */
static char *reserved_name(const char *path)
{
    g_autofree char *folder = g_path_get_dirname(path), *base = g_path_get_basename(path);
    g_autofree char *name = g_strdup_printf(".%s.part", base);
    return g_build_filename(folder, name, NULL);
}

/** An empty locked file of that name, or -1; an error is set if another run writes it. */
static int open_reserved(FlAtomic *file, GError **error)
{
    file->temporary = reserved_name(file->path);
    int fd = fl_lock_take(file->temporary, file->path, error);
    struct stat found;
    if (fd < 0 || fstat(fd, &found) != 0 || found.st_size == 0)
        return fd;
    // A new file: what a killed run left may have an ffmpeg that is not done with it.
    g_unlink(file->temporary);
    close(fd);
    return fl_lock_take(file->temporary, file->path, error);
}

bool fl_atomic_reserve(FlAtomic *file, const char *path, bool overwrite, GError **error)
{
    GError *taken = NULL;
    if (!prepare(file, path, overwrite, error))
        return false;
    const int fd = open_reserved(file, &taken);
    if (fd < 0 && !taken)
        return give_up(file, errno, error);
    if (taken) {
        g_propagate_error(error, taken);
        g_clear_pointer(&file->temporary, g_free); // it is the other's
        fl_atomic_clear(file);
        return false;
    }
    file->stream = fdopen(fd, "rb");
    return true;
}

static bool sync_path(const char *path, int flags)
{
    const int fd = open(path, flags | O_CLOEXEC);
    const bool synced = fd >= 0 && fsync(fd) == 0;
    if (fd >= 0)
        close(fd);
    return synced;
}

static bool sync_file(FlAtomic *file)
{
    return fflush(file->stream) == 0 && fsync(fileno(file->stream)) == 0;
}

/** Gives a nameless file a name; errno is EEXIST if the name is taken. */
static bool name_file(const FlAtomic *file, const char *path)
{
    char self[64];
    g_snprintf(self, sizeof self, "/proc/self/fd/%d", fileno(file->stream));
    return linkat(AT_FDCWD, self, AT_FDCWD, path, AT_SYMLINK_FOLLOW) == 0;
}

/** Renames without replacing; file systems that cannot are asked first. */
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

static bool publish(FlAtomic *file)
{
    if (!file->temporary && !file->overwrite)
        return name_file(file, file->path);
    if (!file->temporary) {
        g_autofree char *name = temporary_name(file->path);
        if (!name_file(file, name))
            return false;
        file->temporary = g_steal_pointer(&name);
    }
    return file->overwrite ? rename(file->temporary, file->path) == 0
                           : rename_new(file->temporary, file->path);
}

bool fl_atomic_commit(FlAtomic *file, GError **error)
{
    if (!sync_file(file) || !publish(file)) {
        if (errno == EEXIST)
            exists_error(error, file->path);
        else
            fl_output_error(error, file->path, errno);
        return false;
    }
    g_clear_pointer(&file->temporary, g_free);
    g_autofree char *folder = g_path_get_dirname(file->path);
    sync_path(folder, O_RDONLY | O_DIRECTORY); // the name's own safety; not every system can
    return true;
}

void fl_atomic_clear(FlAtomic *file)
{
    if (file->stream)
        fclose(file->stream);
    if (file->temporary)
        g_unlink(file->temporary);
    g_free(file->temporary);
    g_free(file->path);
    *file = (FlAtomic){0};
}
