/* A zlib stream of bytes that are mostly long runs of one value, as in layers of a frame. */
#ifndef FLUIDY_IO_SPARSE_STREAM_H
#define FLUIDY_IO_SPARSE_STREAM_H

#include <glib.h>
#include <stddef.h>
#include <stdint.h>

/**
 * A stream that is being written: runs, and a prefix code for all else, since beside runs next to
 * nothing in paint comes twice. Zlib, which does that with Z_RLE, cannot be told where runs are.
 */
typedef struct FlSparseStream FlSparseStream;

/** Begins a stream [RFC 1950] at the end of `out`, which stays the caller's. */
FlSparseStream *fl_sparse_stream_new(GByteArray *out);

/** Adds bytes of any value. */
void fl_sparse_stream_put(FlSparseStream *stream, const uint8_t *bytes, size_t n);

/** Adds n bytes of one value, in next to no time. */
void fl_sparse_stream_run(FlSparseStream *stream, uint8_t value, size_t n);

/** Ends the stream, and frees it. */
void fl_sparse_stream_end(FlSparseStream *stream);

#endif
