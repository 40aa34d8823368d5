#include "io/sparse_stream.h"

#include <zlib.h>

#define PIECE ((size_t)1 << 16) // bytes of 0 that are compressed at a time
#define ADLER_BASE 65521        // of the checksum, RFC 1950

/** Appends what zlib has made of its input. A piece ends with a whole byte and needs none of those
 * before it, so that it may be repeated. */
static void drain(z_stream *zlib, int flush, GByteArray *stream)
{
    uint8_t room[4096];
    do {
        zlib->next_out = room, zlib->avail_out = sizeof room;
        (void)deflate(zlib, flush); // Z_BUF_ERROR: it had nothing left to say
        g_byte_array_append(stream, room, (guint)(sizeof room - zlib->avail_out));
    } while (zlib->avail_out == 0);
}

/** As avail_in is narrow, in parts. */
static void put(z_stream *zlib, const uint8_t *bytes, size_t n, GByteArray *stream)
{
    const size_t most = (size_t)1 << 30;
    for (size_t done = 0; done < n; done += most) {
        zlib->next_in = (z_const Bytef *)(bytes + done);
        zlib->avail_in = (uInt)MIN(n - done, most);
        drain(zlib, Z_FULL_FLUSH, stream);
    }
}

static void put_clear(z_stream *zlib, const uint8_t *clear, size_t n, GByteArray *stream)
{
    const guint first = stream->len;
    if (n >= PIECE)
        put(zlib, clear, PIECE, stream);
    const guint bytes = stream->len - first;
    g_autofree uint8_t *piece = g_memdup2(stream->data + first, bytes);
    for (size_t done = PIECE; done + PIECE <= n; done += PIECE)
        g_byte_array_append(stream, piece, bytes);
    put(zlib, clear, n % PIECE, stream);
}

/** The checksum of so many bytes of 0. */
static uLong adler_of_clear(size_t n)
{
    return (uLong)(n % ADLER_BASE) << 16 | 1;
}

static uLong adler_of(const FlSparse *sparse)
{
    const uLong middle = adler32_z(1, sparse->middle, sparse->n);
    const uLong sum = adler32_combine(adler_of_clear(sparse->before), middle, (z_off_t)sparse->n);
    return adler32_combine(sum, adler_of_clear(sparse->after), (z_off_t)sparse->after);
}

bool fl_sparse_compress(const FlSparse *sparse, int level, GByteArray *stream)
{
    static const uint8_t head[] = {0x78, 0x01}; // deflate, a window of 32 KiB
    z_stream zlib = {0};
    if (deflateInit2(&zlib, level, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        return false;
    g_autofree uint8_t *clear = g_malloc0(PIECE);
    g_byte_array_append(stream, head, sizeof head);
    put_clear(&zlib, clear, sparse->before, stream);
    put(&zlib, sparse->middle, sparse->n, stream);
    put_clear(&zlib, clear, sparse->after, stream);
    drain(&zlib, Z_FINISH, stream);
    deflateEnd(&zlib);
    const uint32_t sum = GUINT32_TO_BE((uint32_t)adler_of(sparse));
    g_byte_array_append(stream, (const uint8_t *)&sum, sizeof sum);
    return true;
}
