/* Reads untrusted files: refuses pipes and devices, bounds the size, can be cancelled. Writes all
 * bytes to a descriptor. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>

/**
 * Checks that the file at `path` can be read to its end: a pipe, whose writer may never come, or a
 * device fails. A missing file passes, since the error of opening it is clearer.
 *
 * Returns: false with an error of `code` that starts with the path.
 */
bool fl_file_check(const char *path, FlError code, GError **error);

/** Controls the wait for the data of a pipe; `stopped` may be NULL. */
typedef struct FlFileWait {
    bool (*stopped)(void *data); // asked every tenth of a second
    void *data;
} FlFileWait;

/**
 * Reads a whole file of at most `most` bytes, whatever size it says it has. With `wait`, a pipe or
 * a device will do, such as the shell's <(…): waits for its end.
 *
 * *data ends with a NUL after *bytes bytes, which are 1 more than `most` if there is more; free it
 * with g_free(). Returns: false with FL_ERROR_INPUT, FL_ERROR_INTERRUPTED if wait->stopped()
 * returns true, FL_ERROR_LIMIT if no data comes within the seconds that a drawing may take.
 */
bool fl_file_read(const char *path, size_t most, const FlFileWait *wait, char **data, size_t *bytes,
                  GError **error);

/** Compares the strings at two pointers to char *, for sorting. */
int fl_by_name(const void *a, const void *b);

/** The names in a folder, sorted; NULL with FL_ERROR_INPUT. To be unref'd. */
GPtrArray *fl_folder_names(const char *folder, GError **error);

/** Removes a file, or a folder with all below it; links are not followed. True if it is missing;
 * false with FL_ERROR_OUTPUT. */
bool fl_file_remove(const char *path, GError **error);

/** Opens a regular file to read it, with more flags of open(). Returns: a descriptor; -1 for one
 * that is missing, a pipe or a device, which could make the program wait. */
int fl_open_regular(const char *path, int flags, size_t *bytes);

/** Writes all of the bytes; a signal does not interrupt the writing. Returns: false with errno. */
bool fl_write_all(int fd, const void *data, size_t bytes);

/** The same from `offset` on, which is not moved. */
bool fl_pwrite_all(int fd, const void *data, size_t bytes, int64_t offset);

/** Reads all of the bytes from `offset` on. Returns: false with errno, 0 where the file ends. */
bool fl_pread_all(int fd, void *data, size_t bytes, int64_t offset);
