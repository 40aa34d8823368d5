#include "render/loop.h"

#include "base/alloc.h"
#include "base/rng.h"

#define SPOT_PX 12     // distance of the spots where the lead-in begins
#define SOFTNESS 0.35f // of a spot's edge; larger is closer to a cross-fade, which is blurred

bool fl_loop_init(FlLoop *loop, int n_pictures, GError **error)
{
    *loop = (FlLoop){.n = fl_loop_length(n_pictures)};
    loop->first = n_pictures - loop->n;
    return loop->n == 0 || (loop->pictures = fl_spill_new((size_t)loop->n, error));
}

void fl_loop_clear(FlLoop *loop)
{
    fl_spill_free(loop->pictures);
    *loop = (FlLoop){0};
}

bool fl_loop_keep(FlLoop *loop, int k, const FlPaintedRegion *painted, GError **error)
{
    return fl_spill_put(loop->pictures, (size_t)k, painted->painted, fl_painted_bytes(painted),
                        error);
}

static float random_at(int column, int row)
{
    const uint64_t bits = fl_key((uint64_t)(int64_t)column, (uint64_t)(int64_t)row);
    return (float)(bits >> 40) / (float)(1 << 24);
}

/* The time at which the lead-in replaces a pixel, 0..1 of its length: a smooth function of the
 * place. */
static float turn_at(int x, int y)
{
    const int column = x / SPOT_PX, row = y / SPOT_PX;
    const float u = (float)(x % SPOT_PX) / SPOT_PX, v = (float)(y % SPOT_PX) / SPOT_PX;
    return (random_at(column, row) * (1 - u) + random_at(column + 1, row) * u) * (1 - v) +
           (random_at(column, row + 1) * (1 - u) + random_at(column + 1, row + 1) * u) * v;
}

static uint8_t between(uint8_t a, uint8_t b, int weight)
{
    return (uint8_t)((a * (256 - weight) + b * weight + 128) >> 8);
}

/* Colours count by their alpha, if they have any. */
static void blend_pixel(const FlPaintedRegion *painted, size_t p, const uint8_t *lead_in,
                        int weight)
{
    const size_t pixels = fl_rect_pixels(painted->rect);
    uint8_t *rgb = painted->painted + 3 * p, *alpha = painted->alpha ? painted->alpha + p : NULL;
    const uint8_t theirs = alpha ? lead_in[3 * pixels + p] : 0;
    const int of_alpha =
        alpha ? weight * theirs / MAX(((256 - weight) * *alpha + weight * theirs) / 256, 1)
              : weight;
    for (size_t c = 0; c < 3; c++)
        rgb[c] = between(rgb[c], lead_in[3 * p + c], MIN(of_alpha, 256));
    if (alpha)
        *alpha = between(*alpha, theirs, weight);
}

bool fl_loop_blend(const FlLoop *loop, int index, FlPaintedRegion *painted, GError **error)
{
    const int k = index - loop->first;
    const FlRect rect = painted->rect;
    const size_t bytes = fl_painted_bytes(painted);
    if (loop->n == 0 || k < 0)
        return true;
    g_autofree uint8_t *lead_in = fl_alloc(bytes, 1, "a picture", error);
    if (!lead_in || !fl_spill_get(loop->pictures, (size_t)k, lead_in, bytes, error))
        return false;
    const float way = (1 + SOFTNESS) * (float)(k + 1) / (float)loop->n; // 1 + SOFTNESS at the last
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < rect.width; x++) {
            const float share = (way - turn_at(rect.x + x, rect.y + y)) / SOFTNESS;
            const int weight = (int)(CLAMP(share, 0, 1) * 256);
            blend_pixel(painted, (size_t)y * (size_t)rect.width + (size_t)x, lead_in, weight);
        }
    return true;
}
