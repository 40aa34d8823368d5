/* Fast compression of what is written often and read once or twice, such as the states of engines:
 * a header, then packed parts. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A piece of memory; several in a row are compressed as one. */
typedef struct FlSpan {
    void *data;
    size_t bytes;
} FlSpan;

/**
 * Packs a header of `size` bytes as it is (NULL: no header), and then `n` parts, which may be 0,
 * without a checksum: a file has one for its whole content.
 *
 * Returns: to be freed with g_bytes_unref(); NULL with FL_ERROR_NO_MEMORY.
 */
GBytes *fl_pack(const void *header, size_t size, const FlSpan *parts, int n, GError **error);

/** Fills the parts from the bytes behind a header. Returns: false if these are not exactly the
 * parts, whose contents are then undefined. The bytes need not be trusted, but altered ones may
 * remain undetected. */
bool fl_unpack(const uint8_t *from, size_t bytes, const FlSpan *parts, int n);

/* ---- states of engines ----------------------------------------------------------------------- */

/** Sets FL_ERROR_CHANGED: a region's state is damaged, and `what`. Returns: false. */
bool fl_state_bytes_damaged(const char *what, GError **error);

/** Copies out the header, which the bytes may be too short for: see fl_state_bytes_damaged(). */
bool fl_state_bytes_header(GBytes *bytes, void *header, size_t size, GError **error);

/** Fills the parts behind a header of `size` bytes, which was read; damaged bytes as above. */
bool fl_state_bytes_parts(GBytes *bytes, size_t size, const FlSpan *parts, int n, GError **error);
