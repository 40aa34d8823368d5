/* The pixels of an OpenEXR chunk, compressed as OpenEXR's ZIP is. */
#ifndef FLUIDY_IO_EXR_CHUNK_H
#define FLUIDY_IO_EXR_CHUNK_H

#include "io/sparse_stream.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A chunk that is filled in the order of its compressor: the low bytes of all its half floats,
 * then their high bytes; both row by row, in a row channel by channel. */
typedef struct FlExrChunk {
    size_t n;              // halves of the whole chunk
    size_t done;           // bytes so far
    uint8_t last;          // the last of them
    size_t run;            // how many at the end are as the one before, beyond `predicted`
    GByteArray *predicted; // what the predictor makes of the others; of a sparse chunk, of those
                           // that are not in the stream
    GByteArray *packed;
    FlSparseStream *stream; // of a sparse chunk
    struct libdeflate_compressor *compressor;
} FlExrChunk;

/** Returns: true; false with FL_ERROR_NO_MEMORY set. To be cleared in both cases. */
bool fl_exr_chunk_init(FlExrChunk *chunk, GError **error);
void fl_exr_chunk_clear(FlExrChunk *chunk); // all 0 is fine

/** Begins a chunk of n halves; sparse: most of them are blank, which takes next to no time where
 * they are many. */
void fl_exr_chunk_begin(FlExrChunk *chunk, size_t n, bool sparse);

/** Adds n bytes of one value, in next to no time. */
void fl_exr_chunk_run(FlExrChunk *chunk, uint8_t value, size_t n);

/** Adds n bytes of any value. */
void fl_exr_chunk_put(FlExrChunk *chunk, const uint8_t *bytes, size_t n);

/**
 * Ends a chunk, of which all bytes are there.
 *
 * Returns: what is stored, until the chunk begins anew: *n_bytes, 2 n if they do not get smaller.
 */
const uint8_t *fl_exr_chunk_end(FlExrChunk *chunk, size_t *n_bytes);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlExrChunk, fl_exr_chunk_clear)

#endif
