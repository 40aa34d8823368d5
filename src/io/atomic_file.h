/* Files that appear whole or not at all. */
#ifndef FLUIDY_IO_ATOMIC_FILE_H
#define FLUIDY_IO_ATOMIC_FILE_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdio.h>

/**
 * A file that is being written. Until fl_atomic_commit() nothing is seen under its name.
 *
 * It has no name at all where the file system can do that; else, and for the moment in which it
 * replaces another, it is ".NAME.part" beside that, which fl_atomic_clear() removes. The file is
 * locked: what a killed program left under that name goes when NAME is written again, and what
 * another run is writing stays.
 */
typedef struct FlAtomicFile {
    FILE *stream;    // write here; of a reserved file it only holds the lock
    char *path;      // the name to be
    char *temporary; // NULL: without a name
    bool overwrite;
} FlAtomicFile;

/**
 * Begins a file, making its folder if need be.
 *
 * Returns: false with FL_ERROR_EXISTS if the file exists and overwrite is false or another run is
 * writing it, or FL_ERROR_OUTPUT; then nothing needs to be cleared.
 */
bool fl_atomic_open(FlAtomicFile *file, const char *path, bool overwrite, GError **error);

/** The same for a program that writes the file itself: it has the name file->temporary. */
bool fl_atomic_reserve(FlAtomicFile *file, const char *path, bool overwrite, GError **error);

/**
 * Syncs the file and gives it its name. The file needs clearing in any case.
 *
 * Returns: false with FL_ERROR_OUTPUT (a full disk, for instance), or FL_ERROR_EXISTS if a file of
 * that name has appeared meanwhile or another run is writing it; the name is then as it was.
 */
bool fl_atomic_commit(FlAtomicFile *file, GError **error);

/** Closes and forgets the file; one that was not committed is gone. */
void fl_atomic_clear(FlAtomicFile *file);

/** Sets FL_ERROR_OUTPUT: "path: cannot be written: " and the system's words for errno_value. */
void fl_output_error(GError **error, const char *path, int errno_value);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlAtomicFile, fl_atomic_clear)

#endif
