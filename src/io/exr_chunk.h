/* The pixels of an OpenEXR chunk, compressed as OpenEXR's ZIP is. */
#ifndef FLUIDY_IO_EXR_CHUNK_H
#define FLUIDY_IO_EXR_CHUNK_H

#include <fluidy/error.h>
#include <glib.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A chunk's half floats in the file's order: row by row, in a row channel by channel. */
typedef struct FlExrChunk {
    size_t n;       // halves of a whole chunk, >= 1
    uint8_t *low;   // n: the halves' low bytes, filled by the caller
    uint8_t *high;  // n, right behind: their high bytes
    uint8_t *bytes; // of the chunk's own
    size_t room;
    struct libdeflate_compressor *compressor;
    GByteArray *stream; // the last one, if the chunk was sparse
} FlExrChunk;

/**
 * Makes a chunk of n halves.
 *
 * Returns: true; false with FL_ERROR_NO_MEMORY set. To be cleared in both cases.
 */
bool fl_exr_chunk_init(FlExrChunk *chunk, size_t n, GError **error);

/** All halves 0. */
void fl_exr_chunk_blank(FlExrChunk *chunk);

/**
 * The first n halves as they are stored, and how many bytes that is: 2 n if they do not get
 * smaller.
 *
 * Returns: the chunk's own bytes, until it is next packed.
 */
const void *fl_exr_chunk_pack(FlExrChunk *chunk, size_t n, size_t *n_bytes);

void fl_exr_chunk_clear(FlExrChunk *chunk); // all 0 is fine
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlExrChunk, fl_exr_chunk_clear)

#endif
