/* Bytes in less room, in little time: what is written often and read once or twice. */
#ifndef FLUIDY_BASE_COMPRESS_H
#define FLUIDY_BASE_COMPRESS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** One of the places that bytes are packed from, or unpacked to, one after the other. */
typedef struct FlSpan {
    void *data;
    size_t bytes;
} FlSpan;

/** The bytes that parts may need when they are packed, whatever is in them. */
size_t fl_compress_bound(const FlSpan *parts, int n);

/** Packs parts into `to`, with a checksum. Returns: the bytes used, > 0; 0 without memory. */
size_t fl_compress(const FlSpan *parts, int n, uint8_t *to, size_t room);

/** Whether `from` is exactly such parts, which are filled. The bytes need not be trusted; where
 * they are not what was packed, the parts hold anything. */
bool fl_decompress(const uint8_t *from, size_t bytes, const FlSpan *parts, int n);

#endif
