#include "base/reader.h"

FlReader fl_reader_of(GBytes *bytes)
{
    FlReader reader = {.failed = !bytes};
    if (bytes)
        reader.at = g_bytes_get_data(bytes, &reader.left);
    return reader;
}

const uint8_t *fl_reader_take(FlReader *reader, size_t n, size_t each)
{
    size_t bytes;
    const uint8_t *at = reader->at;
    if (reader->failed || __builtin_mul_overflow(n, each, &bytes) || bytes > reader->left) {
        reader->failed = true;
        return NULL;
    }
    reader->at += bytes, reader->left -= bytes;
    return at;
}

void fl_reader_copy(FlReader *reader, void *to, size_t bytes)
{
    const uint8_t *from = fl_reader_take(reader, bytes, 1);
    if (from)
        memcpy(to, from, bytes);
    else
        memset(to, 0, bytes);
}

size_t fl_reader_count(FlReader *reader, size_t most)
{
    uint64_t count;
    fl_reader_copy(reader, &count, sizeof count);
    reader->failed = reader->failed || count > most;
    return reader->failed ? 0 : (size_t)count;
}

FlRect fl_reader_rect(FlReader *reader, FlRect page)
{
    FlRect rect;
    fl_reader_copy(reader, &rect, sizeof rect);
    reader->failed = reader->failed || !fl_rect_is_inside(rect, page);
    return reader->failed ? (FlRect){0} : rect;
}

bool fl_reader_ends(const FlReader *reader)
{
    return !reader->failed && reader->left == 0;
}
