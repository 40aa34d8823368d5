/* Sealed files: what is kept for a later run, behind a checksum or, with a key, behind a keyed
 * digest. They are read like a stranger's files. */
#pragma once

#include "base/compress.h"
#include <fluidy/error.h>

/**
 * Reads the key from the file that FLUIDY_CACHE_KEY names, once in a process. Files are not keyed
 * if that variable is unset. Returns: false with FL_ERROR_USAGE if the file is not there, a pipe,
 * empty or above 64 KiB.
 */
bool fl_sealed_read_key(GError **error);

/**
 * Reads a regular file, not a link, and checks its seal. A file that was sealed with another key
 * counts as missing, since it is meant for another reader.
 *
 * *damaged may be NULL. Returns: what was sealed, to be freed with g_bytes_unref(); NULL if the
 * file is missing, or if it is damaged or memory is short, which sets *damaged.
 */
GBytes *fl_sealed_read(const char *path, bool *damaged);

/** Writes the seal and the parts, which are read as one. Returns: false with errno. */
bool fl_sealed_write(int fd, const FlSpan *parts, int n);
