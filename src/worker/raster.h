/* Boxes of a surface, and compositing of pixels. */
#pragma once

#include "base/rect.h"
#include "base/surface.h"
#include <stdbool.h>

/** Clears the pixels of a box. */
void fl_surface_wipe(cairo_surface_t *surface, FlRect box);

/** The smallest box of all pixels that are not 0, within `box`; A8 or ARGB32. */
FlRect fl_surface_bounds(cairo_surface_t *surface, FlRect box);

/** a over b for coverages and opacities 0..255. */
static inline uint8_t fl_over(uint8_t a, uint8_t b)
{
    return (uint8_t)(a + (b * (255 - a) + 127) / 255);
}

/** Draws colour with opacity o (0..255) over a premultiplied ARGB32 pixel. */
static inline uint32_t fl_blend(uint32_t below, const uint8_t rgb[3], uint32_t o)
{
    const uint32_t rest = 255 - o;
    uint32_t out = 0;
    if (rest == 0) // as nearly all pixels
        return 0xff000000u | (uint32_t)rgb[0] << 16 | (uint32_t)rgb[1] << 8 | rgb[2];
    const uint32_t source[4] = {rgb[2] * o, rgb[1] * o, rgb[0] * o, 255 * o};
    for (int c = 0; c < 4; c++)
        out |= (source[c] + ((below >> (8 * c)) & 255) * rest + 127) / 255 << (8 * c);
    return out;
}

/** One straight RGBA pixel of a premultiplied one; its opacity becomes `alpha`. */
static inline void fl_straighten(uint32_t pixel, uint8_t alpha, uint8_t out[4])
{
    const uint32_t a = pixel >> 24;
    for (int c = 0; c < 3; c++)
        out[c] = (uint8_t)(a ? MIN(255, (((pixel >> (16 - 8 * c)) & 255) * 255 + a / 2) / a) : 0);
    out[3] = alpha;
}
