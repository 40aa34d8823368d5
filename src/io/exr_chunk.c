#include "io/exr_chunk.h"

#include "base/alloc.h"

#include <libdeflate.h>
#include <string.h>

#define LEVEL 4 // most of a file of many layers is 0, for which level 1 takes twice the time

bool fl_exr_chunk_init(FlExrChunk *chunk, size_t n, GError **error)
{
    *chunk = (FlExrChunk){.n = n, .compressor = libdeflate_alloc_compressor(LEVEL)};
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

const void *fl_exr_chunk_pack(FlExrChunk *chunk, size_t n, size_t *n_bytes)
{
    uint8_t *stream = chunk->bytes + 2 * n;
    predict(chunk->low, n, 0, chunk->bytes);
    predict(chunk->high, n, n > 0 ? chunk->low[n - 1] : 0, chunk->bytes + n);
    chunk->bytes[0] = (uint8_t)(chunk->bytes[0] - 128); // the first one stands as it is
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
    free(chunk->low);
    free(chunk->bytes);
    *chunk = (FlExrChunk){0};
}
