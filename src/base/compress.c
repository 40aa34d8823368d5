/*
 * Blocks of LZ4, each behind its size: the planes of a region's guides take a sixth of the time
 * that zlib takes at level 1, and a quarter of the time on the way back, for a quarter more bytes.
 */
#include "base/compress.h"

#include "base/alloc.h"
#include "base/error.h"
#include <lz4.h>
#include <string.h>

#define MOST_BYTES ((size_t)1 << 30) // of a part in a block

/* The bytes of the block that begins at `at` of a part. */
static size_t block_bytes(const FlSpan *part, size_t at)
{
    return MIN(part->bytes - at, MOST_BYTES);
}

static size_t most_packed(const FlSpan *parts, int n)
{
    size_t room = 0;
    for (int k = 0; k < n; k++)
        for (size_t at = 0; at < parts[k].bytes; at += MOST_BYTES)
            room += sizeof(uint32_t) + (size_t)LZ4_compressBound((int)block_bytes(&parts[k], at));
    return room;
}

/* Returns: the bytes used, of at most_packed(). */
static size_t compress(const FlSpan *parts, int n, uint8_t *to)
{
    size_t used = 0;
    for (int k = 0; k < n; k++)
        for (size_t at = 0; at < parts[k].bytes; at += MOST_BYTES) {
            const int bytes = (int)block_bytes(&parts[k], at);
            const int packed = LZ4_compress_default((const char *)parts[k].data + at,
                                                    (char *)to + used + sizeof(uint32_t), bytes,
                                                    LZ4_compressBound(bytes));
            memcpy(to + used, &(uint32_t){(uint32_t)packed}, sizeof(uint32_t));
            used += sizeof(uint32_t) + (size_t)packed;
        }
    return used;
}

bool fl_unpack(const uint8_t *from, size_t bytes, const FlSpan *parts, int n)
{
    for (int k = 0; k < n; k++)
        for (size_t at = 0; at < parts[k].bytes; at += MOST_BYTES) {
            const int wanted = (int)block_bytes(&parts[k], at);
            uint32_t packed;
            if (bytes < sizeof packed)
                return false;
            memcpy(&packed, from, sizeof packed);
            from += sizeof packed, bytes -= sizeof packed;
            if (packed > bytes || packed > G_MAXINT ||
                LZ4_decompress_safe((const char *)from, (char *)parts[k].data + at, (int)packed,
                                    wanted) != wanted)
                return false;
            from += packed, bytes -= packed;
        }
    return bytes == 0;
}

GBytes *fl_pack(const void *header, size_t size, const FlSpan *parts, int n, GError **error)
{
    g_autofree uint8_t *bytes =
        fl_alloc_scratch(size + most_packed(parts, n), 1, "a packed part of a picture", error);
    if (!bytes)
        return NULL;
    if (size > 0)
        memcpy(bytes, header, size);
    size += compress(parts, n, bytes + size);
    bytes = g_realloc(bytes, MAX(size, 1)); // it is kept: no more bytes than needed
    return g_bytes_new_take(g_steal_pointer(&bytes), size);
}

/* ---- states of engines ----------------------------------------------------------------------- */

bool fl_state_bytes_damaged(const char *what, GError **error)
{
    return fl_fail(error, FL_ERROR_CHANGED, "a region's state is damaged: %s", what);
}

bool fl_state_bytes_header(GBytes *bytes, void *header, size_t size, GError **error)
{
    size_t whole;
    const void *data = g_bytes_get_data(bytes, &whole);
    if (whole < size)
        return fl_state_bytes_damaged("it is cut short", error);
    memcpy(header, data, size);
    return true;
}

bool fl_state_bytes_parts(GBytes *bytes, size_t size, const FlSpan *parts, int n, GError **error)
{
    size_t whole;
    const uint8_t *data = g_bytes_get_data(bytes, &whole);
    return fl_unpack(data + size, whole - size, parts, n) ||
           fl_state_bytes_damaged("its pictures cannot be read", error);
}
