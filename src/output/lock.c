#include "output/lock.h"

#include <errno.h>
#include <fcntl.h>
#include <stdbool.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

/* Whoever had the lock before may have removed the name meanwhile. */
static bool still_named(int fd, const char *path)
{
    struct stat own, named;
    return fstat(fd, &own) == 0 && stat(path, &named) == 0 && own.st_ino == named.st_ino &&
           own.st_dev == named.st_dev;
}

int fl_lock_take(const char *path, const char *what, GError **error)
{
    for (;;) {
        const int fd = open(path, O_CREAT | O_RDWR | O_CLOEXEC, 0666);
        if (fd < 0)
            return -1;
        const bool taken = flock(fd, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
        if (!taken && still_named(fd, path))
            return fd;
        close(fd);
        if (taken) {
            g_set_error(error, FL_ERROR, FL_ERROR_EXISTS, "%s: another run is writing it", what);
            return -1;
        }
    }
}
