/* The mutator of PNG files for libFuzzer: it changes what is in chunks and makes their sums right,
 * and pixels under their compression. */
#include <glib.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>
#include <zlib.h>

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);

#define LARGEST (1 << 20) // bytes of pixels, unpacked

typedef struct Chunk {
    size_t at, n; // of the data; the length stands 8 bytes before it, the sum behind it
} Chunk;

static uint32_t number_at(const uint8_t *data)
{
    return (uint32_t)data[0] << 24 | (uint32_t)data[1] << 16 | (uint32_t)data[2] << 8 | data[3];
}

static void put_number(GByteArray *out, uint32_t value)
{
    const uint8_t bytes[4] = {(uint8_t)(value >> 24), (uint8_t)(value >> 16), (uint8_t)(value >> 8),
                              (uint8_t)value};
    g_byte_array_append(out, bytes, 4);
}

/** All chunks of all pictures among the bytes. */
static GArray *find_chunks(const uint8_t *data, size_t size)
{
    static const uint8_t mark[8] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
    GArray *chunks = g_array_new(FALSE, FALSE, sizeof(Chunk));
    const uint8_t *end = data + size;
    for (const uint8_t *at = memmem(data, size, mark, sizeof mark); at;) {
        at += sizeof mark;
        while (end - at >= 12 && number_at(at) <= (size_t)(end - at) - 12) {
            const Chunk chunk = {(size_t)(at - data) + 8, number_at(at)};
            g_array_append_val(chunks, chunk);
            at += chunk.n + 12;
        }
        at = memmem(at, (size_t)(end - at), mark, sizeof mark);
    }
    return chunks;
}

static void put_chunk(GByteArray *out, const uint8_t *name, const uint8_t *data, size_t n)
{
    const guint begin = out->len + 4;
    put_number(out, (uint32_t)n);
    g_byte_array_append(out, name, 4);
    g_byte_array_append(out, data, (guint)n);
    put_number(out, (uint32_t)crc32(0, out->data + begin, (uInt)n + 4));
}

/** Changes the pixels of a chunk that holds all of them; false if it does not. */
static bool change_pixels(GByteArray *content)
{
    uLongf n = LARGEST;
    g_autofree uint8_t *pixels = g_malloc(LARGEST);
    if (uncompress(pixels, &n, content->data, content->len) != Z_OK)
        return false;
    n = LLVMFuzzerMutate(pixels, n, MIN(n + 64, LARGEST));
    uLongf room = compressBound(n);
    g_byte_array_set_size(content, (guint)room);
    compress2(content->data, &room, pixels, n, 1);
    g_byte_array_set_size(content, (guint)room);
    return true;
}

static void change_content(GByteArray *content, bool may_be_pixels)
{
    if (may_be_pixels && change_pixels(content))
        return;
    const guint n = content->len;
    g_byte_array_set_size(content, n + 16);
    g_byte_array_set_size(content, (guint)LLVMFuzzerMutate(content->data, n, n + 16));
}

/** The bytes with one chunk changed, repeated, left out or moved to where another one is. */
static GByteArray *change_chunk(const uint8_t *data, size_t size, const GArray *chunks,
                                unsigned chance)
{
    const Chunk *which = &g_array_index(chunks, Chunk, chance % chunks->len);
    const Chunk *other = &g_array_index(chunks, Chunk, chance / 7 % chunks->len);
    const unsigned how = chance / 49 % 8;
    g_autoptr(GByteArray) content = g_byte_array_new();
    g_byte_array_append(content, data + which->at, (guint)which->n);
    if (how >= 3)
        change_content(content, memcmp(data + which->at - 4, "IDAT", 4) == 0 && how % 2);
    GByteArray *out = g_byte_array_new();
    const size_t from = which->at - 8, to = which->at + which->n + 4;
    const size_t place = how == 1 || how == 2 ? other->at - 8 : from;
    const bool left_out = how != 1; // from its old place
    for (size_t at = 0; at < size; at++) {
        if (at == place && how != 0)
            put_chunk(out, data + which->at - 4, content->data, content->len);
        if (left_out && at == from)
            at = to;
        if (at < size)
            g_byte_array_append(out, data + at, 1);
    }
    return out;
}

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    g_autoptr(GArray) chunks = find_chunks(data, size);
    if (chunks->len == 0 || seed % 16 == 0)
        return LLVMFuzzerMutate(data, size, most);
    g_autoptr(GByteArray) out = change_chunk(data, size, chunks, seed / 16);
    if (out->len > most || out->len == 0)
        return LLVMFuzzerMutate(data, size, most);
    memcpy(data, out->data, out->len);
    return out->len;
}
