#include "watercolour/scan.h"

#include "base/alloc.h"
#include "watercolour/kubelka_munk.h"
#include "watercolour/pigment_mask.h"

#include <math.h>

FlScan *fl_scan_new(int width, int height, GError **error)
{
    g_autoptr(FlScan) scan = g_new0(FlScan, 1);
    scan->width = width, scan->height = height;
    const size_t pixels = (size_t)width * height;
    if (!(scan->rgb = fl_alloc(pixels, 3, "a scan", error)) ||
        !(scan->mask = fl_alloc(pixels, 1, "a scan", error)))
        return NULL;
    return g_steal_pointer(&scan);
}

void fl_scan_free(FlScan *scan)
{
    if (!scan)
        return;
    free(scan->rgb);
    free(scan->mask);
    g_free(scan);
}

/* Along a side of a px of the recipe. */
static int cells_per_px(const FlSheet *sheet, const FlRecipe *recipe)
{
    return sheet->width / recipe->width;
}

/* Light from the upper left: a slope towards it is a little brighter. */
static double light(const FlSheet *sheet, const FlRecipe *recipe, int i, int j)
{
    const float *h = &sheet->relief[(size_t)j * sheet->width + i];
    const float along = i < sheet->width - 1 ? h[1] - h[0] : 0;
    const float down = j < sheet->height - 1 ? h[sheet->width] - h[0] : 0;
    return 1 + recipe->paper.shading * (float)cells_per_px(sheet, recipe) * (double)(along + down);
}

/* A fine sheet's pigment is all in `settled`. */
static double pigment_at(const FlSheet *sheet, int k, size_t at)
{
    const double floating = sheet->floating[k] ? (double)sheet->floating[k][at] : 0;
    return floating + (double)sheet->settled[k][at];
}

/* All pigments of a cell are one layer; K and S are means weighted by thickness [C97 §5.2]. */
static void cell_colour(const FlSheet *sheet, const FlRecipe *recipe, int i, int j, double rgb[3])
{
    const size_t at = (size_t)j * sheet->width + i;
    double thickness = 0, k_sum[3] = {0}, s_sum[3] = {0};
    for (int k = 0; k < sheet->n_pigments; k++) {
        const double x = pigment_at(sheet, k, at);
        thickness += x;
        for (int c = 0; c < 3; c++) {
            k_sum[c] += x * (double)recipe->pigments[k].absorption[c];
            s_sum[c] += x * (double)recipe->pigments[k].scattering[c];
        }
    }
    const double lit = light(sheet, recipe, i, j);
    for (int c = 0; c < 3; c++) {
        const FlKmLayer paper = {fmin(1, recipe->paper.colour[c] / 255.0 * lit), 0};
        const FlKmLayer paint = fl_km_layer(k_sum[c], s_sum[c], (double)recipe->flow.thickness);
        rgb[c] += thickness > 0 ? fl_km_over(paint, paper).reflectance : paper.reflectance;
    }
}

static void draw_pixel(FlScan *scan, const FlSheet *sheet, const FlRecipe *recipe, int x, int y)
{
    const int scale = sheet->width / scan->width;
    double rgb[3] = {0};
    for (int j = 0; j < scale; j++)
        for (int i = 0; i < scale; i++)
            cell_colour(sheet, recipe, x * scale + i, y * scale + j, rgb);
    for (int c = 0; c < 3; c++)
        scan->rgb[3 * ((size_t)y * scan->width + x) + c] =
            (uint8_t)(255 * fmin(1, fmax(0, rgb[c] / (scale * scale))) + 0.5);
}

static void draw_mask(FlScan *scan, const float *distance, int scale)
{
    for (int y = 0; y < scan->height; y++)
        for (int x = 0; x < scan->width; x++) {
            float sum = 0;
            for (int j = 0; j < scale; j++)
                for (int i = 0; i < scale; i++) {
                    const size_t at =
                        (size_t)(y * scale + j) * (scan->width * scale) + x * scale + i;
                    sum += fmaxf(0, fminf(1, distance[at] / (float)scale + 0.5f));
                }
            uint8_t *mask = &scan->mask[(size_t)y * scan->width + x];
            const uint8_t coverage = (uint8_t)(255 * sum / (float)(scale * scale) + 0.5f);
            *mask = coverage > *mask ? coverage : *mask;
        }
}

static bool find_mask(FlScan *scan, const FlSheet *sheet, const FlRecipe *recipe, GError **error)
{
    const size_t cells = (size_t)sheet->width * sheet->height;
    g_autofree float *thickness = fl_alloc(cells, sizeof(float), "a mask", error);
    g_autofree float *distance = thickness ? fl_alloc(cells, sizeof(float), "a mask", error) : NULL;
    if (!distance)
        return false;
    for (int k = 0; k < sheet->n_pigments; k++)
        for (size_t i = 0; i < cells; i++)
            thickness[i] += recipe->flow.thickness * (float)pigment_at(sheet, k, i);
    const int scale = cells_per_px(sheet, recipe), area = scale * scale;
    const FlExtract extract = {recipe->mask_threshold,
                               (int)(recipe->mask_blur * (float)scale + 0.5f), 60 * area, 60 * area,
                               recipe->mask_margin * (float)scale};
    if (!fl_extract_mask(thickness, sheet->width, sheet->height, &extract, distance, error))
        return false;
    draw_mask(scan, distance, sheet->width / scan->width);
    return true;
}

bool fl_scan_draw(FlScan *scan, const FlSheet *sheet, const FlRecipe *recipe, GError **error)
{
#pragma omp parallel for schedule(static)
    for (int y = 0; y < scan->height; y++)
        for (int x = 0; x < scan->width; x++)
            draw_pixel(scan, sheet, recipe, x, y);
    return find_mask(scan, sheet, recipe, error);
}
