#include "io/sparse_stream.h"

#include <string.h>
#include <zlib.h>

#define PIECE ((size_t)1 << 10) // bytes of the shortest piece; each other one is twice as long
#define PIECES 7
#define MOST_AT_ONCE ((size_t)1 << 30) // what avail_in holds
#define ADLER_BASE 65521               // of the checksum, RFC 1950

struct FlSparseStream {
    z_stream zlib;
    GByteArray *out;
    uLong sum;
    uint8_t value;             // of the pieces
    GByteArray *piece[PIECES]; // compressed; NULL: not yet
};

/** Appends what zlib has made of its input. */
static void drain(z_stream *zlib, int flush, GByteArray *out)
{
    uint8_t room[4096];
    do {
        zlib->next_out = room, zlib->avail_out = sizeof room;
        (void)deflate(zlib, flush); // Z_BUF_ERROR: it had nothing left to say
        g_byte_array_append(out, room, (guint)(sizeof room - zlib->avail_out));
    } while (zlib->avail_out == 0);
}

FlSparseStream *fl_sparse_stream_new(int level, bool runs, GByteArray *out)
{
    static const uint8_t head[] = {0x78, 0x01}; // deflate, a window of 32 KiB
    FlSparseStream *stream = g_new0(FlSparseStream, 1);
    *stream = (FlSparseStream){.out = out, .sum = 1};
    if (deflateInit2(&stream->zlib, level, Z_DEFLATED, -MAX_WBITS, 8,
                     runs ? Z_RLE : Z_DEFAULT_STRATEGY) != Z_OK) {
        g_free(stream);
        return NULL;
    }
    g_byte_array_append(out, head, sizeof head);
    return stream;
}

/** Compresses bytes, which are not counted; what follows needs none of them. */
static void compress_apart(FlSparseStream *stream, const uint8_t *bytes, size_t n, GByteArray *out)
{
    for (size_t done = 0; done < n; done += MOST_AT_ONCE) {
        stream->zlib.next_in = (z_const Bytef *)(bytes + done);
        stream->zlib.avail_in = (uInt)MIN(n - done, MOST_AT_ONCE);
        drain(&stream->zlib, Z_FULL_FLUSH, out);
    }
}

void fl_sparse_stream_put(FlSparseStream *stream, const uint8_t *bytes, size_t n)
{
    compress_apart(stream, bytes, n, stream->out);
    stream->sum = adler32_z(stream->sum, bytes, n);
}

/** The checksum of a run. */
static uLong sum_of_run(uint8_t value, size_t n)
{
    const uint64_t m = n % (2 * (uint64_t)ADLER_BASE); // it has that period
    const uint64_t low = (1 + m * value) % ADLER_BASE;
    const uint64_t high = (m + (m * (m + 1) / 2 % ADLER_BASE) * value) % ADLER_BASE;
    return (uLong)(high << 16 | low);
}

static void clear_pieces(FlSparseStream *stream)
{
    for (int k = 0; k < PIECES; k++)
        g_clear_pointer(&stream->piece[k], g_byte_array_unref);
}

static void put_piece(FlSparseStream *stream, int k)
{
    if (!stream->piece[k]) {
        g_autofree uint8_t *bytes = g_malloc(PIECE << k);
        memset(bytes, stream->value, PIECE << k);
        stream->piece[k] = g_byte_array_new();
        compress_apart(stream, bytes, PIECE << k, stream->piece[k]);
    }
    g_byte_array_append(stream->out, stream->piece[k]->data, stream->piece[k]->len);
}

void fl_sparse_stream_run(FlSparseStream *stream, uint8_t value, size_t n)
{
    uint8_t rest[PIECE];
    size_t left = n;
    if (value != stream->value)
        clear_pieces(stream);
    stream->value = value;
    for (int k = PIECES - 1; k >= 0; k--)
        for (; left >= PIECE << k; left -= PIECE << k)
            put_piece(stream, k);
    memset(rest, value, left);
    compress_apart(stream, rest, left, stream->out);
    stream->sum = adler32_combine(stream->sum, sum_of_run(value, n), (z_off_t)n);
}

void fl_sparse_stream_end(FlSparseStream *stream)
{
    drain(&stream->zlib, Z_FINISH, stream->out);
    const uint32_t sum = GUINT32_TO_BE((uint32_t)stream->sum);
    g_byte_array_append(stream->out, (const uint8_t *)&sum, sizeof sum);
    deflateEnd(&stream->zlib);
    clear_pieces(stream);
    g_free(stream);
}
