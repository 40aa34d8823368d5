#include "base/state_bytes.h"

#include "base/alloc.h"
#include "base/error.h"
#include <string.h>

/*
 * Parts are cut into pieces, which threads pack and unpack side by side. Behind the header come the
 * packed bytes of each, then the pieces.
 */
#define PIECE ((size_t)1 << 18)

typedef struct Piece {
    FlSpan span;   // of a part
    size_t at;     // its offset after the list
    uint32_t used; // bytes there
} Piece;

static GArray *cut(const FlSpan *parts, int n)
{
    GArray *pieces = g_array_new(FALSE, TRUE, sizeof(Piece));
    for (int k = 0; k < n; k++)
        for (size_t at = 0; at < parts[k].bytes; at += PIECE) {
            const Piece piece = {
                .span = {(uint8_t *)parts[k].data + at, MIN(PIECE, parts[k].bytes - at)}};
            g_array_append_val(pieces, piece);
        }
    return pieces;
}

static size_t list_bytes(const GArray *pieces)
{
    return pieces->len * sizeof(uint32_t);
}

/* Packs all pieces, which have room for the worst, and closes the gaps between them. Returns: the
 * bytes used; 0: memory is short. */
static size_t pack_pieces(GArray *pieces, uint8_t *to)
{
    Piece *piece = (Piece *)(void *)pieces->data;
    bool failed = false;
#pragma omp parallel for schedule(dynamic, 1) reduction(|| : failed) if (pieces->len > 1)
    for (guint k = 0; k < pieces->len; k++) {
        piece[k].used = (uint32_t)fl_compress(&piece[k].span, 1, to + piece[k].at,
                                              fl_compress_bound(&piece[k].span, 1));
        failed = failed || piece[k].used == 0;
    }
    size_t used = 0;
    for (guint k = 0; k < pieces->len; used += piece[k++].used)
        memmove(to + used, to + piece[k].at, piece[k].used);
    return failed ? 0 : used;
}

GBytes *fl_state_bytes_pack(const void *header, size_t size, const FlSpan *parts, int n,
                            GError **error)
{
    g_autoptr(GArray) pieces = cut(parts, n);
    size_t room = 0;
    for (guint k = 0; k < pieces->len; k++) {
        Piece *piece = &g_array_index(pieces, Piece, k);
        piece->at = room;
        room += fl_compress_bound(&piece->span, 1);
    }
    const size_t front = size + list_bytes(pieces);
    g_autofree uint8_t *bytes = fl_alloc_scratch(front + room, 1, "the state of a region", error);
    if (!bytes)
        return NULL;
    if (size > 0)
        memcpy(bytes, header, size);
    const size_t packed = pack_pieces(pieces, bytes + front);
    if (pieces->len > 0 && packed == 0) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to pack a state");
        return NULL;
    }
    for (guint k = 0; k < pieces->len; k++)
        memcpy(bytes + size + k * sizeof(uint32_t), &g_array_index(pieces, Piece, k).used,
               sizeof(uint32_t));
    bytes = g_realloc(bytes, front + packed); // it is kept: no more bytes than needed
    return g_bytes_new_take(g_steal_pointer(&bytes), front + packed);
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

/* Reads the list of pieces. Returns: whether they are as many bytes as there are. */
static bool find_pieces(GArray *pieces, const uint8_t *data, size_t bytes)
{
    if (bytes < list_bytes(pieces))
        return false;
    size_t at = 0;
    for (guint k = 0; k < pieces->len; k++) {
        Piece *piece = &g_array_index(pieces, Piece, k);
        memcpy(&piece->used, data + k * sizeof piece->used, sizeof piece->used);
        piece->at = at;
        at += piece->used;
    }
    return at == bytes - list_bytes(pieces);
}

static bool unpack_pieces(const GArray *pieces, const uint8_t *from)
{
    const Piece *piece = (const Piece *)(const void *)pieces->data;
    bool whole = true;
#pragma omp parallel for schedule(dynamic, 1) reduction(&& : whole) if (pieces->len > 1)
    for (guint k = 0; k < pieces->len; k++)
        whole = fl_decompress(from + piece[k].at, piece[k].used, &piece[k].span, 1) && whole;
    return whole;
}

bool fl_state_bytes_parts(GBytes *bytes, size_t size, const FlSpan *parts, int n, GError **error)
{
    size_t whole;
    const uint8_t *data = g_bytes_get_data(bytes, &whole);
    g_autoptr(GArray) pieces = cut(parts, n);
    return (find_pieces(pieces, data + size, whole - size) &&
            unpack_pieces(pieces, data + size + list_bytes(pieces))) ||
           fl_state_bytes_damaged("its pictures cannot be read", error);
}
