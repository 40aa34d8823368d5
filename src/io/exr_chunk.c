#include "io/exr_chunk.h"

#include "base/alloc.h"
#include "io/sparse_stream.h"

#include <libdeflate.h>
#include <string.h>

#define LEVEL 4
#define SPARSE_LEVEL 4     // zlib's
#define SAME 128           // the predictor's byte where a byte is as the one before
#define BLOCK 1024         // bytes that are looked at together
#define RUN_BLOCKS 4       // from which on a run is worth a piece of its own
#define SPARSE_SHARE 0.75f // of a chunk, in runs: then zlib's speed with the rest does not matter

bool fl_exr_chunk_init(FlExrChunk *chunk, size_t n, GError **error)
{
    *chunk = (FlExrChunk){
        .n = n, .compressor = libdeflate_alloc_compressor(LEVEL), .stream = g_byte_array_new()};
    if (!chunk->compressor) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to compress");
        return false;
    }
    // what is stored: differences, and behind them their stream
    chunk->room = 2 * n + libdeflate_zlib_compress_bound(chunk->compressor, 2 * n);
    chunk->low = fl_alloc(2, n, "rows of an OpenEXR file", error);
    chunk->high = chunk->low ? chunk->low + n : NULL;
    chunk->bytes =
        chunk->low ? fl_alloc_scratch(chunk->room, 1, "rows of an OpenEXR file", error) : NULL;
    return chunk->bytes != NULL;
}

void fl_exr_chunk_blank(FlExrChunk *chunk)
{
    memset(chunk->low, 0, 2 * chunk->n);
}

/* OpenEXR's predictor [ImfZip.cpp, "Predictor"]: each byte less the one before, and 128. */
static void predict(const uint8_t *bytes, size_t n, uint8_t before, uint8_t *restrict out)
{
    if (n > 0)
        out[0] = (uint8_t)(bytes[0] - before + 128);
    for (size_t i = 1; i < n; i++)
        out[i] = (uint8_t)(bytes[i] - bytes[i - 1] + 128);
}

/* Whether a block of the bytes is all SAME. */
static bool is_same(const uint8_t *bytes)
{
    return bytes[0] == SAME && memcmp(bytes, bytes + 1, BLOCK - 1) == 0;
}

/* How many bytes from `at` on, in whole blocks, are SAME. */
static size_t run_at(const uint8_t *bytes, size_t at, size_t n)
{
    size_t end = at;
    while (end + BLOCK <= n && is_same(bytes + end))
        end += BLOCK;
    return end - at;
}

static bool is_sparse(const uint8_t *bytes, size_t n)
{
    size_t blank = 0;
    for (size_t at = 0; at + BLOCK <= n; at += BLOCK)
        blank += is_same(bytes + at) ? BLOCK : 0;
    return (float)blank > SPARSE_SHARE * (float)n;
}

/* Layers are small in a large frame: most of the bytes lie in long runs. Returns: false if memory
 * is short. */
static bool compress_sparse(const uint8_t *bytes, size_t n, GByteArray *out)
{
    FlSparseStream *stream = fl_sparse_stream_new(SPARSE_LEVEL, out);
    if (!stream)
        return false;
    size_t put = 0; // those before are in the stream
    for (size_t at = 0; at < n;) {
        const size_t run = run_at(bytes, at, n);
        if (run >= RUN_BLOCKS * BLOCK) {
            fl_sparse_stream_put(stream, bytes + put, at - put);
            fl_sparse_stream_run(stream, SAME, run);
            put = at + run;
        }
        at += MAX(run, BLOCK);
    }
    fl_sparse_stream_put(stream, bytes + put, n - put);
    fl_sparse_stream_end(stream);
    return true;
}

const void *fl_exr_chunk_pack(FlExrChunk *chunk, size_t n, size_t *n_bytes)
{
    uint8_t *stream = chunk->bytes + 2 * n;
    predict(chunk->low, n, 0, chunk->bytes);
    predict(chunk->high, n, n > 0 ? chunk->low[n - 1] : 0, chunk->bytes + n);
    chunk->bytes[0] = (uint8_t)(chunk->bytes[0] - 128); // the first one stands as it is
    g_byte_array_set_size(chunk->stream, 0);
    if (is_sparse(chunk->bytes, 2 * n) && compress_sparse(chunk->bytes, 2 * n, chunk->stream)) {
        *n_bytes = chunk->stream->len;
        return chunk->stream->data;
    }
    *n_bytes = libdeflate_zlib_compress(chunk->compressor, chunk->bytes, 2 * n, stream,
                                        chunk->room - 2 * n);
    if (*n_bytes > 0 && *n_bytes < 2 * n)
        return stream;
    for (size_t i = 0; i < n; i++)
        chunk->bytes[2 * i] = chunk->low[i], chunk->bytes[2 * i + 1] = chunk->high[i];
    *n_bytes = 2 * n;
    return chunk->bytes;
}

void fl_exr_chunk_clear(FlExrChunk *chunk)
{
    if (chunk->compressor)
        libdeflate_free_compressor(chunk->compressor);
    g_clear_pointer(&chunk->stream, g_byte_array_unref);
    free(chunk->low);
    free(chunk->bytes);
    *chunk = (FlExrChunk){0};
}
