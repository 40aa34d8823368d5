/* Files that appear whole or not at all, and locks, so that two processes never write the same file
 * at the same time. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdio.h>

/**
 * A file that is being written. Its name appears with fl_atomic_commit() only.
 *
 * Until then it is ".NAME.part" in the same folder, which fl_atomic_clear() removes. The file is
 * locked: the next writer of NAME removes the leftover of a killed process, but never one that is
 * being written.
 */
typedef struct FlAtomicFile {
    FILE *stream;    // write here, or by the name `temporary`
    char *path;      // its final name
    char *temporary; // its present one; NULL: it has its final name
    bool overwrite;
} FlAtomicFile;

/**
 * Begins a file, making its folder if need be.
 *
 * Returns: false with FL_ERROR_EXISTS if the file exists and overwrite is false or another process
 * is writing the file, or FL_ERROR_OUTPUT; the file then needs no clearing.
 */
bool fl_atomic_open(FlAtomicFile *file, const char *path, bool overwrite, GError **error);

/**
 * Syncs the file and gives it its name. The file needs clearing in any case.
 *
 * Returns: false with FL_ERROR_OUTPUT (a full disk, for instance), or FL_ERROR_EXISTS if a file of
 * that name has appeared meanwhile, which is then unchanged.
 */
bool fl_atomic_commit(FlAtomicFile *file, GError **error);

/** The same once the file's mark is completed: fl_mark_seal(). */
bool fl_atomic_seal(FlAtomicFile *file, const char *mark, GError **error);

/** Closes the file; without a commit it is removed. */
void fl_atomic_clear(FlAtomicFile *file);

/** Sets FL_ERROR_OUTPUT: "path: cannot be written: " and the system's words for errno_value. */
void fl_output_error(GError **error, const char *path, int errno_value);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlAtomicFile, fl_atomic_clear)

/* ---- locks ----------------------------------------------------------------------------------- */

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
