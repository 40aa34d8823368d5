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
