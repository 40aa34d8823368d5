#include "render/loop.h"

#include "base/alloc.h"
#include "base/rng.h"

#define SPOT_PX 12     // distance of the spots from which the lead-in spreads
#define SOFTNESS 0.35f // of a spot's edge; all at once would be a cross-fade, which is blurred

bool fl_loop_init(FlLoop *loop, int n_pictures, GError **error)
{
    *loop = (FlLoop){.n = MIN(n_pictures / 3, FL_LOOP_LONGEST)};
    loop->first = n_pictures - loop->n;
    return loop->n == 0 || (loop->pictures = fl_spill_new((size_t)loop->n, error));
}

void fl_loop_clear(FlLoop *loop)
{
    fl_spill_free(loop->pictures);
    *loop = (FlLoop){0};
}

bool fl_loop_keep(FlLoop *loop, int k, const uint8_t *rgb, FlRect box, GError **error)
{
    return fl_spill_put(loop->pictures, (size_t)k, rgb, 3 * fl_rect_pixels(box), error);
}

static float corner(int column, int row)
{
    const uint64_t bits = fl_key((uint64_t)(int64_t)column, (uint64_t)(int64_t)row);
    return (float)(bits >> 40) / (float)(1 << 24);
}

/* When the lead-in takes a pixel, 0 … 1 of the way: a smooth function of the place in the frame. */
static float turn_of(int x, int y)
{
    const int column = x / SPOT_PX, row = y / SPOT_PX;
    const float u = (float)(x % SPOT_PX) / SPOT_PX, v = (float)(y % SPOT_PX) / SPOT_PX;
    return (corner(column, row) * (1 - u) + corner(column + 1, row) * u) * (1 - v) +
           (corner(column, row + 1) * (1 - u) + corner(column + 1, row + 1) * u) * v;
}

bool fl_loop_blend(const FlLoop *loop, int index, uint8_t *rgb, FlRect box, GError **error)
{
    const int k = index - loop->first;
    const size_t bytes = 3 * fl_rect_pixels(box);
    if (loop->n == 0 || k < 0)
        return true;
    g_autofree uint8_t *lead_in = fl_alloc(bytes, 1, "a picture", error);
    if (!lead_in || !fl_spill_get(loop->pictures, (size_t)k, lead_in, bytes, error))
        return false;
    const float way = (1 + SOFTNESS) * (float)(k + 1) / (float)loop->n; // the last has gone it all
    for (int y = 0; y < box.height; y++)
        for (int x = 0; x < box.width; x++) {
            const float share = (way - turn_of(box.x + x, box.y + y)) / SOFTNESS;
            const int weight = (int)(CLAMP(share, 0, 1) * 256);
            const size_t p = 3 * ((size_t)y * box.width + x);
            for (int c = 0; c < 3; c++)
                rgb[p + c] =
                    (uint8_t)((rgb[p + c] * (256 - weight) + lead_in[p + c] * weight + 128) >> 8);
        }
    return true;
}
