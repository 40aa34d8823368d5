#include "io/exr_chunk.h"

#include <libdeflate.h>
#include <string.h>

#define LEVEL 4
#define SAME 128          // the predictor's byte where a byte is as the one before
#define SPARSE_LEAST 1024 // halves; the stream of fewer may be larger than they are

bool fl_exr_chunk_init(FlExrChunk *chunk, GError **error)
{
    *chunk = (FlExrChunk){.compressor = libdeflate_alloc_compressor(LEVEL),
                          .predicted = g_byte_array_new(),
                          .packed = g_byte_array_new()};
    if (!chunk->compressor)
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to compress");
    return chunk->compressor;
}

void fl_exr_chunk_clear(FlExrChunk *chunk)
{
    if (chunk->compressor)
        libdeflate_free_compressor(chunk->compressor);
    if (chunk->stream)
        fl_sparse_stream_end(chunk->stream);
    g_clear_pointer(&chunk->predicted, g_byte_array_unref);
    g_clear_pointer(&chunk->packed, g_byte_array_unref);
    *chunk = (FlExrChunk){0};
}

void fl_exr_chunk_begin(FlExrChunk *chunk, size_t n, bool sparse)
{
    chunk->n = n, chunk->done = chunk->run = 0, chunk->last = 0;
    g_byte_array_set_size(chunk->predicted, 0);
    g_byte_array_set_size(chunk->packed, 0);
    chunk->stream = sparse && n >= SPARSE_LEAST ? fl_sparse_stream_new(chunk->packed) : NULL;
}

/* Room for n more bytes. */
static uint8_t *grow(GByteArray *bytes, size_t n)
{
    const guint before = bytes->len;
    g_byte_array_set_size(bytes, before + (guint)n);
    return bytes->data + before;
}

/* What is not in the stream goes there. */
static void drain(FlExrChunk *chunk)
{
    if (chunk->predicted->len > 0)
        fl_sparse_stream_put(chunk->stream, chunk->predicted->data, chunk->predicted->len);
    g_byte_array_set_size(chunk->predicted, 0);
}

static void end_run(FlExrChunk *chunk)
{
    if (chunk->stream && chunk->run > 0) {
        drain(chunk);
        fl_sparse_stream_run(chunk->stream, SAME, chunk->run);
    } else if (chunk->run > 0)
        memset(grow(chunk->predicted, chunk->run), SAME, chunk->run);
    chunk->run = 0;
}

/* OpenEXR's predictor [ImfZip.cpp, "Predictor"]: each byte less the one before, and 128; the first
 * one stands as it is. */
static void predict(FlExrChunk *chunk, const uint8_t *bytes, size_t n)
{
    uint8_t *restrict to = grow(chunk->predicted, n);
    to[0] = (uint8_t)(bytes[0] - chunk->last + (chunk->done > 0 ? SAME : 0));
    for (size_t i = 1; i < n; i++)
        to[i] = (uint8_t)(bytes[i] - bytes[i - 1] + SAME);
    chunk->last = bytes[n - 1];
    chunk->done += n;
}

void fl_exr_chunk_run(FlExrChunk *chunk, uint8_t value, size_t n)
{
    size_t left = n;
    if (left > 0 && (chunk->done == 0 || chunk->last != value)) {
        end_run(chunk);
        predict(chunk, &value, 1);
        left--;
    }
    chunk->run += left;
    chunk->done += left;
}

void fl_exr_chunk_put(FlExrChunk *chunk, const uint8_t *bytes, size_t n)
{
    if (n == 0)
        return;
    if (memcmp(bytes, bytes + 1, n - 1) == 0) {
        fl_exr_chunk_run(chunk, bytes[0], n);
        return;
    }
    end_run(chunk);
    predict(chunk, bytes, n);
}

/* The chunk without compression: what the predictor was given, low and high bytes by turns. */
static const uint8_t *plain(FlExrChunk *chunk)
{
    const uint8_t *predicted = chunk->predicted->data;
    g_byte_array_set_size(chunk->packed, (guint)(2 * chunk->n));
    uint8_t byte = 0;
    for (size_t i = 0; i < 2 * chunk->n; i++) {
        byte = (uint8_t)(byte + predicted[i] - (i > 0 ? SAME : 0));
        chunk->packed->data[i < chunk->n ? 2 * i : 2 * (i - chunk->n) + 1] = byte;
    }
    return chunk->packed->data;
}

const uint8_t *fl_exr_chunk_end(FlExrChunk *chunk, size_t *n_bytes)
{
    const size_t n = 2 * chunk->n;
    g_assert(chunk->done == n);
    end_run(chunk);
    if (chunk->stream) {
        drain(chunk);
        fl_sparse_stream_end(g_steal_pointer(&chunk->stream));
        *n_bytes = chunk->packed->len;
        return chunk->packed->data;
    }
    const size_t room = libdeflate_zlib_compress_bound(chunk->compressor, n);
    g_byte_array_set_size(chunk->packed, (guint)room);
    *n_bytes = libdeflate_zlib_compress(chunk->compressor, chunk->predicted->data, n,
                                        chunk->packed->data, room);
    if (*n_bytes > 0 && *n_bytes < n)
        return chunk->packed->data;
    *n_bytes = n;
    return plain(chunk);
}
