#include "io/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

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
            g_set_error(error, FL_ERROR, FL_ERROR_EXISTS, "%s: another run is writing it", what);
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
