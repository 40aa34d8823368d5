#include "regions/filmdata.h"
#include "regions/raster.h"
#include <string.h>

/** Lays n pixels of a run, from p on, over straight RGBA. */
static void lay_row(const FlRun *run, const uint8_t *rgb, size_t p, int n, uint8_t *rgba)
{
    for (uint8_t *out = rgba; out < rgba + 4 * (size_t)n; out += 4, p++) {
        const uint32_t a = (run->coverage[p] * run->alpha + 127) / 255;
        if (a == 0)
            continue;
        uint8_t colour[3];
        memcpy(colour, rgb ? rgb : run->picture ? run->picture + 4 * p : run->rgb, 3);
        if (!rgb && run->mix != FL_MIX_OVER)
            fl_mix(run->mix, out, out[3], colour);
        const uint32_t rest = out[3] * (255 - a); // weights out of 255 * 255
        const uint32_t all = 255 * a + rest;
        for (int c = 0; c < 3; c++)
            out[c] = (uint8_t)((colour[c] * 255 * a + out[c] * rest + all / 2) / all);
        out[3] = (uint8_t)((all + 127) / 255);
    }
}

/** Lays a run over a frame, `width` wide; with a colour of its own if rgb is given. */
static void lay(const FlRun *run, const uint8_t *rgb, int width, uint8_t *rgba)
{
    const FlBox box = run->area.box;
    for (int y = 0; y < box.height; y++)
        lay_row(run, rgb, (size_t)y * (size_t)box.width, box.width,
                rgba + 4 * ((size_t)(box.y + y) * (size_t)width + (size_t)box.x));
}

void fl_runs_flat(const FlRuns *runs, int width, int height, uint8_t *rgba)
{
    memset(rgba, 0, 4 * (size_t)width * (size_t)height);
    for (int r = 0; r < runs->n; r++)
        lay(&runs->run[r], NULL, width, rgba);
}

/** Distinct colours: hues a golden angle apart, in three lightnesses. */
void fl_region_colour(const FlFilm *film, int region, uint8_t rgb[3])
{
    int nth = 0;
    const bool paintable = fl_film_region(film, region)->paintable;
    for (int r = 0; r < region; r++)
        nth += fl_film_region(film, r)->paintable == paintable;
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

void fl_runs_map(const FlFilm *film, const FlRuns *runs, uint8_t *rgba)
{
    memset(rgba, 0, 4 * (size_t)film->width * (size_t)film->height);
    for (int r = 0; r < runs->n; r++) {
        uint8_t rgb[3];
        fl_region_colour(film, runs->run[r].region, rgb);
        lay(&runs->run[r], rgb, film->width, rgba);
    }
}
