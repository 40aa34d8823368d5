/* Masks of regions and flat pictures, from draws. */
#include "drawing/drawing_data.h"
#include "worker/raster.h"
#include <string.h>

/** Composites n pixels of a draw, from p on, over straight RGBA. */
static void lay_row(const FlDraw *draw, const uint8_t *rgb, size_t p, int n, uint8_t *rgba)
{
    for (uint8_t *out = rgba; out < rgba + 4 * (size_t)n; out += 4, p++) {
        const uint32_t a = (draw->coverage[p] * draw->alpha + 127) / 255;
        if (a == 0)
            continue;
        uint8_t colour[3];
        memcpy(colour, rgb ? rgb : draw->picture ? draw->picture + 4 * p : draw->rgb, 3);
        if (!rgb && draw->blend_mode != FL_BLEND_MODE_OVER)
            fl_blend_mode_apply(draw->blend_mode, out, out[3], colour);
        const uint32_t rest = out[3] * (255 - a); // weights out of 255 * 255
        const uint32_t all = 255 * a + rest;
        for (int c = 0; c < 3; c++)
            out[c] = (uint8_t)((colour[c] * 255 * a + out[c] * rest + all / 2) / all);
        out[3] = (uint8_t)((all + 127) / 255);
    }
}

/** Composites a draw over a frame `width` pixels wide; in the colour rgb unless that is NULL. */
static void lay(const FlDraw *draw, const uint8_t *rgb, int width, uint8_t *rgba)
{
    const FlRect box = draw->area.box;
    for (int y = 0; y < box.height; y++)
        lay_row(draw, rgb, (size_t)y * (size_t)box.width, box.width,
                rgba + 4 * ((size_t)(box.y + y) * (size_t)width + (size_t)box.x));
}

void fl_draw_list_flat(const FlDrawList *draws, int width, int height, uint8_t *rgba)
{
    memset(rgba, 0, 4 * (size_t)width * (size_t)height);
    for (int r = 0; r < draws->n; r++)
        lay(&draws->draw[r], NULL, width, rgba);
}

/** Distinct colours: hues a golden angle apart, in three lightnesses. */
void fl_region_colour(const FlDrawing *drawing, int region, uint8_t rgb[3])
{
    int nth = 0;
    const bool paintable = fl_drawing_region(drawing, region)->paintable;
    for (int r = 0; r < region; r++)
        nth += fl_drawing_region(drawing, r)->paintable == paintable;
    if (!paintable) {
        rgb[0] = rgb[1] = rgb[2] = (uint8_t)(40 + nth * 37 % 120);
        return;
    }
    const double turn = nth * 0.6180339887498949;
    const double hue = 6 * (turn - (int)turn);
    const int high = nth % 3 == 1 ? 170 : 240, low = nth % 3 == 2 ? 130 : 40;
    const int sector = (int)hue;
    const double part = hue - sector;
    const int up = low + (int)((high - low) * part), down = high - (up - low);
    const int table[6][3] = {{high, up, low},   {down, high, low}, {low, high, up},
                             {low, down, high}, {up, low, high},   {high, low, down}};
    for (int c = 0; c < 3; c++)
        rgb[c] = (uint8_t)table[sector % 6][c];
}

void fl_draw_list_map(const FlDrawing *drawing, const FlDrawList *draws, uint8_t *rgba)
{
    memset(rgba, 0, 4 * (size_t)drawing->width * (size_t)drawing->height);
    for (int r = 0; r < draws->n; r++) {
        uint8_t rgb[3];
        fl_region_colour(drawing, draws->draw[r].region, rgb);
        lay(&draws->draw[r], rgb, drawing->width, rgba);
    }
}

/* ---- masks ----------------------------------------------------------------------------------- */

#define SEEN 3       // coverage that is seen
#define CONTOUR_PX 2 // as wide as coverage rises at a contour

/**
 * Returns: true if a pixel that is covered in part belongs to a shape that fades, such as a glow or
 * a blurred shadow: it is not at a contour, for all around it on the page is seen. Such a pixel is
 * inside as any other, and opacity is the layer's: a mask that fell from full to half coverage
 * along a glow would have a contour there.
 */
static bool fades(const FlDraw *draw, FlRect page, int x, int y)
{
    const FlRect box = draw->area.box;
    const int x0 = MAX(x - CONTOUR_PX, page.x - box.x);
    const int x1 = MIN(x + CONTOUR_PX, page.x + page.width - 1 - box.x);
    const int y0 = MAX(y - CONTOUR_PX, page.y - box.y);
    const int y1 = MIN(y + CONTOUR_PX, page.y + page.height - 1 - box.y);
    if (x0 < 0 || y0 < 0 || x1 >= box.width || y1 >= box.height)
        return false;
    for (int row = y0; row <= y1; row++)
        for (int column = x0; column <= x1; column++)
            if (draw->coverage[(size_t)row * (size_t)box.width + (size_t)column] < SEEN)
                return false;
    return true;
}

static bool is_faint(uint8_t coverage)
{
    return coverage > 0 && coverage < 255;
}

/** Adds a row over the rows of lower draws. Returns: true if a pixel of the row is covered in
 * part. */
static bool put_over(const uint8_t *from, FlColumns span, uint8_t *restrict to)
{
    uint8_t any = 0;
    for (int x = span.first; x < span.last; x++) {
        any |= is_faint(from[x]);
        to[x] = fl_over(from[x], to[x]);
    }
    return any;
}

FlRect fl_draw_list_mask(const FlDrawList *draws, int region, int width, int height,
                         uint8_t *coverage)
{
    const FlRect page = {0, 0, width, height};
    FlRect around = {0, 0, 0, 0};
    for (int r = 0; r < draws->n; r++) {
        const FlDraw *draw = &draws->draw[r];
        const FlRect box = draw->area.box;
        for (int y = 0; draw->region == region && y < box.height; y++) {
            const FlColumns span = fl_area_row(&draw->area, y);
            const uint8_t *from = draw->coverage + (size_t)y * (size_t)box.width;
            uint8_t *to = coverage + (size_t)(box.y + y) * (size_t)width + (size_t)box.x;
            if (!put_over(from, span, to))
                continue;
            for (int x = span.first; x < span.last; x++)
                if (is_faint(from[x]) && fades(draw, page, x, y))
                    to[x] = 255;
        }
        if (draw->region == region)
            around = fl_rect_or(around, box);
    }
    return around;
}
