/* Fast compression of what is written often and read once or twice. */
#ifndef FLUIDY_BASE_COMPRESS_H
#define FLUIDY_BASE_COMPRESS_H

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

#endif
