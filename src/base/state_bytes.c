#include "base/state_bytes.h"

#include "base/alloc.h"
#include "base/error.h"
#include <string.h>

GBytes *fl_state_bytes_pack(const void *header, size_t size, const FlSpan *parts, int n,
                            GError **error)
{
    const size_t room = n > 0 ? fl_compress_bound(parts, n) : 0;
    g_autofree uint8_t *bytes = fl_alloc_scratch(size + room, 1, "the state of a region", error);
    if (!bytes)
        return NULL;
    if (size > 0)
        memcpy(bytes, header, size);
    const size_t packed = n > 0 ? fl_compress(parts, n, bytes + size, room) : 0;
    if (n > 0 && packed == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to pack a state");
        return NULL;
    }
    bytes = g_realloc(bytes, size + packed); // it is kept: no more bytes than needed
    return g_bytes_new_take(g_steal_pointer(&bytes), size + packed);
}

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
    return (n == 0 ? whole == size : fl_decompress(data + size, whole - size, parts, n)) ||
           fl_state_bytes_damaged("its pictures cannot be read", error);
}
