#include "base/wire.h"

#include <string.h>

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

FlWireReader fl_reader(const void *data, size_t bytes)
{
    return (FlWireReader){data, bytes, true};
}

void fl_take(FlWireReader *r, void *data, size_t bytes)
{
    r->good = r->good && bytes <= r->left;
    if (bytes == 0)
        return;
    if (!r->good) {
        memset(data, 0, bytes);
        return;
    }
    memcpy(data, r->at, bytes);
    r->at += bytes, r->left -= bytes;
}

int fl_take_int(FlWireReader *r)
{
    int value;
    fl_take(r, &value, sizeof value);
    return value;
}

int fl_take_in(FlWireReader *r, int first, int last)
{
    const int value = fl_take_int(r);
    return fl_take_check(r, value >= first && value <= last) ? value : first;
}

int fl_take_count(FlWireReader *r, size_t size)
{
    const int n = fl_take_int(r);
    return fl_take_check(r, n >= 0 && (size_t)n <= r->left / size) ? n : 0;
}

const char *fl_take_text(FlWireReader *r)
{
    const char *text = (const char *)r->at;
    const char *end = r->good && r->left > 0 ? memchr(text, '\0', r->left) : NULL;
    if (!fl_take_check(r, end != NULL))
        return "";
    const size_t bytes = (size_t)(end - text) + 1;
    r->at += bytes, r->left -= bytes;
    return text;
}

char **fl_take_texts(FlWireReader *r)
{
    const int n = fl_take_count(r, 1);
    char **texts = n > 0 ? g_new0(char *, (size_t)n + 1) : NULL;
    for (int i = 0; i < n; i++)
        texts[i] = g_strdup(fl_take_text(r));
    return texts;
}

void *fl_take_items(FlWireReader *r, size_t size, int *n)
{
    *n = fl_take_count(r, size);
    void *items = *n > 0 ? g_malloc_n((size_t)*n, size) : NULL;
    fl_take(r, items, (size_t)*n * size);
    return items;
}

bool fl_take_check(FlWireReader *r, bool sound)
{
    return r->good = r->good && sound;
}
