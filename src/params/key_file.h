/* Key files: sections of "key = value" lines, with the line number of everything. */
#ifndef FLUIDY_PARAMS_KEY_FILE_H
#define FLUIDY_PARAMS_KEY_FILE_H

#include "base/file.h"
#include <fluidy/error.h>
#include <stdbool.h>

/** The callbacks of a reader; each returns false with an error that names no file or line. */
typedef struct FlKeyReader {
    /** A "[name]" line; name has no outer spaces. */
    bool (*section)(void *data, const char *name, int line, GError **error);
    /** A "key = value" line below the last section; neither has outer spaces; value may be "". */
    bool (*entry)(void *data, const char *key, const char *value, int line, GError **error);
    void *data;
    FlError mistake;        // the error code for syntax errors
    const FlFileWait *wait; // for a pipe; NULL: only a regular file will do
    const char *text;       // of the file, which is then not read; NULL: it is read
} FlKeyReader;

/**
 * Reads a UTF-8 file from top to bottom. Lines that are empty or start with # or ; are comments; a
 * value goes to the end of its line. A file of more than 1 MiB is refused.
 *
 * Returns: false with the first error, "FILE:LINE: …" in front; FL_ERROR_INPUT when the file cannot
 * be read, reader->mistake for syntax errors, or the error of the reader.
 */
bool fl_key_file_read(const char *path, const FlKeyReader *reader, GError **error);

/** Items between semicolons, without outer spaces; empty ones are left out. g_strfreev(). */
char **fl_key_file_list(const char *value);

#endif
