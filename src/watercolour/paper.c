/* Paper from noise and fibres: relief, capacity, permeability. No scanned data, no licence. */
#include "base/curves.h"
#include "base/noise.h"
#include "base/rng.h"
#include "watercolour/sheet.h"

#include <math.h>

enum { KEY_BUMPS = 101, KEY_TOOTH, KEY_FIBRES, KEY_PATCHES, KEY_PIN };

/* Bumps like those of felt: two sizes of noise, creased where they cross 0, and a fine tooth. */
static float bump(uint64_t seed, const FlPaper *paper, float x, float y)
{
    const float sx = x / (paper->grain_px * paper->stretch), sy = y / paper->grain_px;
    const float coarse = fl_noise_octaves(fl_key(seed, KEY_BUMPS), sx, sy, 2, 0.5f);
    const float crease = 1 - 2 * fabsf(fl_noise(fl_key(seed, KEY_TOOTH), sx * 1.7f, sy * 1.7f));
    const float tooth = fl_noise_octaves(fl_key(seed, KEY_TOOTH), x / 1.6f, y / 1.6f, 2, 0.7f);
    return 0.5f + 0.30f * coarse + 0.10f * crease + 0.22f * paper->roughness * tooth;
}

static void draw_fibres(FlSheet *sheet, const FlRecipe *recipe, float *grid)
{
    const float scale = (float)recipe->oversample;
    const FlFibre fibre = {recipe->paper.fibre_px, recipe->paper.fibre_curl, scale};
    const int n = (int)(recipe->paper.fibres * (float)recipe->width * (float)recipe->height / 100);
    for (int i = 0; i < n; i++) {
        FlRng rng = {fl_key(fl_key(recipe->seed, KEY_FIBRES), (uint64_t)i)};
        const float x = fl_rng_float(&rng) * (float)sheet->width;
        const float y = fl_rng_float(&rng) * (float)sheet->height;
        fl_fibre_draw(grid, sheet->width, sheet->height, x, y, &fibre, &rng);
    }
}

/* A positive factor from noise, 1 on the average in the logarithm, without exp(). */
static float factor(float contrast, float noise)
{
    const float x = fl_clamp(contrast * noise, -0.97f, 0.97f);
    return (1 + x) / (1 - x);
}

/* Permeability of the cells, 0..1: patches of several sizes times fibres. */
static float openness(const FlRecipe *recipe, float x, float y, float fibre)
{
    const FlPaper *paper = &recipe->paper;
    const float patch = fl_noise_octaves(fl_key(recipe->seed, KEY_PATCHES), x / paper->patch_px,
                                         y / paper->patch_px, 4, 0.75f);
    const float base = 1 - paper->fibre_pull * (1 - fibre);
    return fl_clamp(0.8f * factor(paper->patchiness, patch) * base, 0.002f, 1);
}

static void make_cells(FlSheet *sheet, const FlRecipe *recipe, const float *fibres, float *open)
{
    const FlPaper *paper = &recipe->paper;
    const float px = 1.0f / (float)recipe->oversample;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < sheet->width; i++) {
            const size_t at = (size_t)j * sheet->width + i;
            const float x = (float)i * px, y = (float)j * px;
            const float h =
                fl_clamp(bump(recipe->seed, paper, x, y) + 0.2f * fibres[at], 0.02f, 0.98f);
            const float pin =
                fl_noise_octaves(fl_key(recipe->seed, KEY_PIN), x / 3, y / 3, 2, 0.8f);
            sheet->relief[at] = h;
            sheet->capacity[at] =
                paper->capacity[0] + h * (paper->capacity[1] - paper->capacity[0]);
            open[at] = openness(recipe, x, y, fibres[at]);
            sheet->pin[at] = fl_clamp(1 + paper->pinning * (2 * pin - 1.5f * fibres[at]), 0.05f, 4);
        }
}

/* The permeability of a face is limited by both its cells. */
static void make_faces(FlSheet *sheet, const float *open)
{
    const int width = sheet->width, height = sheet->height;
    for (int j = 0; j < height; j++)
        for (int i = 1; i < width; i++) {
            const float a = open[(size_t)j * width + i - 1], b = open[(size_t)j * width + i];
            sheet->open_u[(size_t)j * (width + 1) + i] = 2 * a * b / (a + b);
        }
    for (int j = 1; j < height; j++)
        for (int i = 0; i < width; i++) {
            const float a = open[(size_t)(j - 1) * width + i], b = open[(size_t)j * width + i];
            sheet->open_v[(size_t)j * width + i] = 2 * a * b / (a + b);
        }
}

void fl_sheet_make_paper(FlSheet *sheet, const FlRecipe *recipe)
{
    float *fibres = sheet->spare[0], *open = sheet->spare[1];
    draw_fibres(sheet, recipe, fibres);
    make_cells(sheet, recipe, fibres, open);
    make_faces(sheet, open);
}
