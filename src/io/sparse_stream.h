/* A zlib stream of bytes that are mostly long runs of one value, as in layers of a frame. */
#ifndef FLUIDY_IO_SPARSE_STREAM_H
#define FLUIDY_IO_SPARSE_STREAM_H

#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A stream that is being written. Runs take next to no time: pieces of them are compressed once
 * and repeated. */
typedef struct FlSparseStream FlSparseStream;

/** Begins a stream at zlib's level 1 … 9, at the end of `out`, which stays the caller's. runs: of
 * what comes twice, only runs of a byte are looked for. Returns: NULL if memory is short. */
FlSparseStream *fl_sparse_stream_new(int level, bool runs, GByteArray *out);

/** Adds bytes of any value. */
void fl_sparse_stream_put(FlSparseStream *stream, const uint8_t *bytes, size_t n);

/** Adds n bytes of one value. */
void fl_sparse_stream_run(FlSparseStream *stream, uint8_t value, size_t n);

/** Ends the stream, and frees it. */
void fl_sparse_stream_end(FlSparseStream *stream);

#endif
