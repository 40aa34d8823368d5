/* The splicing mutator for libFuzzer. Packed drawings are unpacked. */
#include "splice.h"

#include <string.h>
#include <zlib.h>

size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t most);
size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed);
size_t LLVMFuzzerCustomCrossOver(const uint8_t *data, size_t size, const uint8_t *other,
                                 size_t other_size, uint8_t *out, size_t most, unsigned seed);

#define LARGEST (1 << 20) // bytes of a drawing, unpacked

static GString *text_of(const uint8_t *data, size_t size)
{
    if (size < 2 || data[0] != 0x1f || data[1] != 0x8b)
        return g_string_new_len((const char *)data, (gssize)size);
    GString *text = g_string_sized_new(LARGEST);
    z_stream z = {.next_in = (Bytef *)(uintptr_t)data,
                  .avail_in = (uInt)size,
                  .next_out = (Bytef *)text->str,
                  .avail_out = LARGEST};
    inflateInit2(&z, 15 + 16);
    inflate(&z, Z_FINISH);
    g_string_set_size(text, z.total_out);
    inflateEnd(&z);
    return text;
}

/** Returns: the text's length; 0 if there is no room. */
static size_t give(const GString *text, uint8_t *out, size_t most)
{
    if (text->len > most)
        return 0;
    memcpy(out, text->str, text->len);
    return text->len;
}

#define BYTES 16 // one in so many times the bytes are changed as they come

size_t LLVMFuzzerCustomMutator(uint8_t *data, size_t size, size_t most, unsigned seed)
{
    g_autoptr(GString) text = text_of(data, size);
    if (seed % BYTES != 0)
        splice_mutate(text, seed / BYTES, LLVMFuzzerMutate);
    const size_t n = seed % BYTES ? give(text, data, most) : 0;
    return n > 0 ? n : LLVMFuzzerMutate(data, size, most);
}

size_t LLVMFuzzerCustomCrossOver(const uint8_t *data, size_t size, const uint8_t *other,
                                 size_t other_size, uint8_t *out, size_t most, unsigned seed)
{
    g_autoptr(GString) text = text_of(data, size), from = text_of(other, other_size);
    splice_cross(text, from, seed);
    return give(text, out, most);
}
