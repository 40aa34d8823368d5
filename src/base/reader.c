#include "base/reader.h"

void fl_put(GByteArray *out, const void *data, size_t bytes)
{
    if (bytes > 0)
        g_byte_array_append(out, data, (guint)bytes);
}

void fl_put_int(GByteArray *out, int value)
{
    fl_put(out, &value, sizeof value);
}

void fl_put_text(GByteArray *out, const char *text)
{
    fl_put(out, text ? text : "", text ? strlen(text) + 1 : 1);
}

void fl_put_texts(GByteArray *out, const char *const *texts)
{
    const int n = texts ? (int)g_strv_length((char **)texts) : 0;
    fl_put_int(out, n);
    for (int i = 0; i < n; i++)
        fl_put_text(out, texts[i]);
}

void fl_put_items(GByteArray *out, const void *items, int n, size_t size)
{
    fl_put_int(out, n);
    fl_put(out, items, (size_t)n * size);
}

FlReader fl_reader_over(const void *data, size_t bytes)
{
    return (FlReader){.at = data, .left = bytes};
}

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
    if (from && bytes > 0)
        memcpy(to, from, bytes);
    else if (bytes > 0) // `to` may be NULL for none
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
    const FlRect nothing = {0};
    return reader->failed ? nothing : rect;
}

int fl_take_int(FlReader *r)
{
    int value;
    fl_reader_copy(r, &value, sizeof value);
    return value;
}

int fl_take_in(FlReader *r, int first, int last)
{
    const int value = fl_take_int(r);
    return fl_take_check(r, value >= first && value <= last) ? value : first;
}

int fl_take_count(FlReader *r, size_t size)
{
    const int n = fl_take_int(r);
    return fl_take_check(r, n >= 0 && (size_t)n <= r->left / size) ? n : 0;
}

const char *fl_take_text(FlReader *r)
{
    const char *text = (const char *)r->at;
    const char *end = !r->failed && r->left > 0 ? memchr(text, '\0', r->left) : NULL;
    if (!fl_take_check(r, end != NULL))
        return "";
    const size_t bytes = (size_t)(end - text) + 1;
    r->at += bytes, r->left -= bytes;
    return text;
}

char **fl_take_texts(FlReader *r)
{
    const int n = fl_take_count(r, 1);
    char **texts = n > 0 ? g_new0(char *, (size_t)n + 1) : NULL;
    for (int i = 0; i < n; i++)
        texts[i] = g_strdup(fl_take_text(r));
    return texts;
}

void *fl_take_items(FlReader *r, size_t size, int *n)
{
    *n = fl_take_count(r, size);
    void *items = *n > 0 ? g_malloc_n((size_t)*n, size) : NULL;
    fl_reader_copy(r, items, (size_t)*n * size);
    return items;
}

bool fl_take_check(FlReader *r, bool sound)
{
    r->failed = r->failed || !sound;
    return !r->failed;
}

bool fl_reader_ends(const FlReader *reader)
{
    return !reader->failed && reader->left == 0;
}
