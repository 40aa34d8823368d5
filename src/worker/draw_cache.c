#include "worker/draws.h"

#include "base/alloc.h"
#include <string.h>

#define MOST_BYTES ((size_t)16 << 20) // of a frame

size_t fl_draw_bytes(const FlDraw *draw)
{
    return fl_rect_pixels(draw->area.box) * (draw->picture ? 5 : 1);
}

static void *copy_of(const void *data, size_t bytes, GError **error)
{
    void *copy = data ? fl_alloc_unset(bytes, 1, "the mask of a region", error) : NULL;
    if (copy)
        memcpy(copy, data, bytes);
    return copy;
}

bool fl_draw_copy(const FlDraw *draw, FlDraw *copy, GError **error)
{
    const FlRect box = draw->area.box;
    const size_t n = fl_rect_pixels(box);
    *copy = *draw;
    copy->area.row = g_memdup2(draw->area.row, (size_t)box.height * sizeof *draw->area.row);
    copy->coverage = copy_of(draw->coverage, n, error);
    copy->picture = copy->coverage ? copy_of(draw->picture, 4 * n, error) : NULL;
    return copy->coverage && !copy->picture == !draw->picture;
}

const FlDraw *fl_draw_cache_find(FlFrameCache *cache, FlDigest digest)
{
    const GArray *one = fl_frame_cache_find(cache, digest);
    return one ? &g_array_index(one, FlDraw, 0) : NULL;
}

static void clear(void *draw)
{
    fl_draw_clear(draw);
}

bool fl_draw_cache_keep(FlFrameCache *cache, FlDigest digest, const FlDraw *draw, size_t *bytes,
                        GError **error)
{
    const size_t own = fl_draw_bytes(draw);
    if (!fl_digest_is_known(digest) || *bytes + own > MOST_BYTES)
        return true;
    FlDraw copy;
    GArray *one = g_array_new(FALSE, FALSE, sizeof copy);
    g_array_set_clear_func(one, clear);
    const bool copied = fl_draw_copy(draw, &copy, error);
    g_array_append_val(one, copy);
    fl_frame_cache_keep(cache, digest, one);
    *bytes += own;
    return copied;
}
