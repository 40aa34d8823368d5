/* The bytes in which an engine keeps a region's state: a header, then packed parts. */
#ifndef FLUIDY_BASE_STATE_BYTES_H
#define FLUIDY_BASE_STATE_BYTES_H

#include "base/compress.h"
#include <fluidy/error.h>

/**
 * Packs a header of `size` bytes (NULL: no header) and then `n` parts, which may be 0.
 *
 * Returns: to be freed with g_bytes_unref(); NULL with FL_ERROR_NO_MEMORY.
 */
GBytes *fl_state_bytes_pack(const void *header, size_t size, const FlSpan *parts, int n,
                            GError **error);

/** Sets FL_ERROR_CHANGED: a region's state is damaged, and `what`. Returns: false. */
bool fl_state_bytes_damaged(const char *what, GError **error);

/** Copies out the header, which the bytes may be too short for: see fl_state_bytes_damaged(). */
bool fl_state_bytes_header(GBytes *bytes, void *header, size_t size, GError **error);

/** Fills the parts behind a header of `size` bytes, which was read; damaged bytes as above. */
bool fl_state_bytes_parts(GBytes *bytes, size_t size, const FlSpan *parts, int n, GError **error);

#endif
