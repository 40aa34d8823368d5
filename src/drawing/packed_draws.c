#include "drawing/packed_draws.h"

#include "base/alloc.h"
#include "base/compress.h"

enum { COVERAGE, BY_HAND, PICTURE, N_PLANES };

/* The planes of a draw. */
typedef struct Packed {
    bool has[N_PLANES];
    uint8_t *data;
    size_t bytes;
} Packed;

struct FlPackedDraws {
    FlDrawList *draws; // without planes
    Packed *packed;    // of each
};

static uint8_t **plane_of(FlDraw *draw, int k)
{
    return k == COVERAGE ? &draw->coverage : k == BY_HAND ? &draw->by_hand : &draw->picture;
}

static FlSpan part_of(FlDraw *draw, const Packed *packed, int k)
{
    const size_t pixel = k == PICTURE ? 4 : 1;
    return (FlSpan){*plane_of(draw, k),
                    packed->has[k] ? fl_rect_pixels(draw->area.box) * pixel : 0};
}

static bool pack(FlDraw *draw, Packed *packed, GError **error)
{
    FlSpan parts[N_PLANES];
    for (int k = 0; k < N_PLANES; k++) {
        packed->has[k] = *plane_of(draw, k) != NULL;
        parts[k] = part_of(draw, packed, k);
    }
    const size_t capacity = fl_compress_bound(parts, N_PLANES);
    if (!(packed->data = fl_alloc_scratch(capacity, 1, "a packed drawing", error)))
        return false;
    packed->bytes = fl_compress(parts, N_PLANES, packed->data, capacity);
    packed->data = g_realloc(packed->data, MAX(packed->bytes, 1));
    for (int k = 0; k < N_PLANES; k++)
        g_clear_pointer(plane_of(draw, k), free);
    if (packed->bytes == 0)
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to pack a drawing");
    return packed->bytes > 0;
}

static bool unpack(FlDraw *draw, Packed *packed, GError **error)
{
    FlSpan parts[N_PLANES];
    for (int k = 0; k < N_PLANES; k++) {
        const size_t bytes = part_of(draw, packed, k).bytes;
        if (packed->has[k] && !(*plane_of(draw, k) = fl_alloc(bytes, 1, "a drawing", error)))
            return false;
        parts[k] = part_of(draw, packed, k);
    }
    const bool whole = fl_decompress(packed->data, packed->bytes, parts, N_PLANES);
    g_clear_pointer(&packed->data, g_free);
    if (!whole)
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory to unpack a drawing");
    return whole;
}

FlPackedDraws *fl_packed_draws_new(FlDrawList *draws, GError **error)
{
    g_autoptr(FlPackedDraws) packed = g_new0(FlPackedDraws, 1);
    packed->draws = draws;
    packed->packed = g_new0(Packed, MAX(draws->n, 1));
    for (int r = 0; r < draws->n; r++)
        if (!pack(&draws->draw[r], &packed->packed[r], error))
            return NULL;
    return g_steal_pointer(&packed);
}

void fl_packed_draws_free(FlPackedDraws *packed)
{
    if (!packed)
        return;
    for (int r = 0; packed->draws && r < packed->draws->n; r++)
        g_free(packed->packed[r].data);
    fl_draw_list_free(packed->draws);
    g_free(packed->packed);
    g_free(packed);
}

FlDrawList *fl_packed_draws_open(FlPackedDraws *packed, GError **error)
{
    g_autoptr(FlPackedDraws) owned = packed;
    for (int r = 0; r < packed->draws->n; r++)
        if (!unpack(&packed->draws->draw[r], &packed->packed[r], error))
            return NULL;
    return g_steal_pointer(&owned->draws);
}
