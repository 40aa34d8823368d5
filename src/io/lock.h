/* Locks, so that two processes never write the same file at the same time. */
#ifndef FLUIDY_IO_LOCK_H
#define FLUIDY_IO_LOCK_H

#include <fluidy/error.h>

/**
 * Opens or makes a file in an existing folder and locks it where files can be locked; the
 * lock ends with the descriptor or the process.
 *
 * what names the output in the message: "what: another run is writing it".
 * Returns: a descriptor to be closed; -1 with FL_ERROR_EXISTS set: another process has the lock; -1
 * with errno alone: the file cannot be made.
 */
int fl_lock_take(const char *path, const char *what, GError **error);

/** The same with a folder. */
int fl_lock_take_folder(const char *path, const char *what, GError **error);

#endif
