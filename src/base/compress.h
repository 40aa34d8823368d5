/* Fast compression of what is written often and read once or twice, such as the states of engines:
 * a header, then packed parts. */
#ifndef FLUIDY_BASE_COMPRESS_H
#define FLUIDY_BASE_COMPRESS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A piece of memory; several in a row are compressed as one. */
typedef struct FlSpan {
    void *data;
    size_t bytes;
} FlSpan;

/** An upper bound of the compressed size of parts. */
size_t fl_compress_bound(const FlSpan *parts, int n);

/** Compresses parts into `to`, without a checksum: a file has one for its whole content.
 * Returns: the bytes used; 0: out of memory. */
size_t fl_compress(const FlSpan *parts, int n, uint8_t *to, size_t capacity);

/** Fills the parts. Returns: false if `from` is not exactly these parts, whose contents are then
 * undefined. `from` need not be trusted, but altered bytes may remain undetected. */
bool fl_decompress(const uint8_t *from, size_t bytes, const FlSpan *parts, int n);

/* ---- states of engines ----------------------------------------------------------------------- */

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
