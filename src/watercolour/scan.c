#include "watercolour/scan.h"

#include "base/alloc.h"
#include "compose/kubelka_munk.h"
#include "guides/connected_parts.h"

#include <math.h>

/* ---- the mask, from the thickness of the pigment ---- */

/* Lengths in cells. */
typedef struct Extract {
    float threshold; // of the blurred thickness
    int blur;        // radius of the blur, >= 0
    int speck, hole; // smaller specks of paint and smaller gaps are ignored, cells
    float margin;    // margin of the mask around the paint
} Extract;

#define MARGIN_PX 3 // of bare paper around the paint
#define FAR 1e9f    // squared cells; more than any picture has

/* A box blur of one line; the window is clipped at the ends. */
static void blur_line(float *line, int n, ptrdiff_t stride, int radius, float *copy)
{
    for (int i = 0; i < n; i++)
        copy[i] = line[i * stride];
    for (int i = 0; i < n; i++) {
        const int first = MAX(0, i - radius), last = MIN(n - 1, i + radius);
        float sum = 0;
        for (int k = first; k <= last; k++)
            sum += copy[k];
        line[i * stride] = sum / (float)(last - first + 1);
    }
}

/*
 * Three box blurs are a Gaussian, near enough, and cost the same at every radius. fl_blur() would
 * round otherwise, and styles must rebuild to the same bytes.
 */
static void blur(float *grid, int width, int height, int radius, float *line)
{
    for (int pass = 0; pass < 3; pass++) {
        for (int j = 0; j < height; j++)
            blur_line(grid + (size_t)j * width, width, 1, radius, line);
        for (int i = 0; i < width; i++)
            blur_line(grid + i, height, width, radius, line);
    }
}

/* Drops specks and fills holes; of holes, the specks within do not count. */
static bool drop_small_parts(uint8_t *mask, int width, int height, const Extract *extract,
                             GError **error)
{
    g_auto(FlConnectedParts) paint = {0}, bare = {0};
    if (!fl_connected_parts_init(&paint, mask, width, height, 1, 1, error) ||
        !fl_connected_parts_init(&bare, mask, width, height, 0, 0, error))
        return false;
    fl_connected_parts_drop(&paint, (size_t)extract->speck, 0, mask);
    fl_connected_parts_drop(&bare, (size_t)extract->hole, 1, mask);
    return true;
}

/*
 * Lower envelope of parabolas: squared distances along one line [FH12]. Whole cells suffice here
 * and are exact, so that styles rebuild to the same bytes even if the sub-pixel distances of the
 * guides change.
 */
static void distance_line(float *line, int n, ptrdiff_t stride, float *copy, int *at, float *from)
{
    for (int i = 0; i < n; i++)
        copy[i] = line[i * stride];
    int top = 0;
    at[0] = 0, from[0] = -FAR, from[1] = FAR;
    for (int q = 1; q < n; q++) {
        float cross;
        while ((cross = (copy[q] + (float)q * (float)q - copy[at[top]] -
                         (float)at[top] * (float)at[top]) /
                        (float)(2 * (q - at[top]))) <= from[top])
            top--;
        at[++top] = q;
        from[top] = cross, from[top + 1] = FAR;
    }
    for (int i = 0, k = 0; i < n; i++) {
        while (from[k + 1] < (float)i)
            k++;
        line[i * stride] = copy[at[k]] + (float)(i - at[k]) * (float)(i - at[k]);
    }
}

/* Squared distance to the nearest cell where the mask is `value`. */
static void distance_to(const uint8_t *mask, uint8_t value, int width, int height, float *squared,
                        float *lines)
{
    const int longest = MAX(width, height) + 2;
    int *at = (int *)(lines + 2 * longest);
    for (int i = 0; i < width * height; i++)
        squared[i] = mask[i] == value ? 0 : FAR;
    for (int i = 0; i < width; i++)
        distance_line(squared + i, height, width, lines, at, lines + longest);
    for (int j = 0; j < height; j++)
        distance_line(squared + (size_t)j * width, width, 1, lines, at, lines + longest);
}

/*
 * The signed distance of each cell's centre to the rim of the mask, positive inside, in cells.
 *
 * thickness has width * height values, >= 0, and is blurred in place; distance receives as many.
 * Without paint, all distances are about minus the size of the picture. FL_ERROR_NO_MEMORY.
 */
static bool extract_mask(float *thickness, int width, int height, const Extract *extract,
                         float *distance, GError **error)
{
    const size_t cells = (size_t)width * height;
    g_autofree uint8_t *mask = fl_alloc(cells, 1, "a mask", error);
    g_autofree float *lines =
        mask ? fl_alloc((size_t)MAX(width, height) + 2, 3 * sizeof(float), "a mask", error) : NULL;
    if (!lines)
        return false;
    if (extract->blur > 0)
        blur(thickness, width, height, extract->blur, lines);
    for (size_t i = 0; i < cells; i++)
        mask[i] = thickness[i] > extract->threshold;
    if (!drop_small_parts(mask, width, height, extract, error))
        return false;
    distance_to(mask, 1, width, height, distance, lines);
    distance_to(mask, 0, width, height, thickness, lines);
    for (size_t i = 0; i < cells; i++)
        distance[i] =
            (mask[i] ? sqrtf(thickness[i]) - 0.5f : 0.5f - sqrtf(distance[i])) + extract->margin;
    return true;
}

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
        const FlKmLayer paper = {fmin(1, recipe->style->paper[c] / 255.0 * lit), 0};
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
    const Extract extract = {recipe->mask_threshold, (int)(recipe->mask_blur * (float)scale + 0.5f),
                             60 * area, 60 * area, MARGIN_PX * (float)scale};
    if (!extract_mask(thickness, sheet->width, sheet->height, &extract, distance, error))
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
