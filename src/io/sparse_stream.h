/* A compressed picture of which most rows are clear. */
#ifndef FLUIDY_IO_SPARSE_STREAM_H
#define FLUIDY_IO_SPARSE_STREAM_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Bytes of which only some in the middle are not 0. */
typedef struct FlSparse {
    size_t before, after;  // how many are 0 on either side
    const uint8_t *middle; // n bytes of any value
    size_t n;
} FlSparse;

/**
 * Appends a zlib stream of the bytes, at zlib's level 1 … 9. Clear bytes take next to no time: a
 * piece of them is compressed once and repeated. Returns: false if memory is short.
 */
bool fl_sparse_compress(const FlSparse *sparse, int level, GByteArray *stream);

#endif
