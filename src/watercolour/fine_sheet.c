#include "watercolour/fine_sheet.h"

#include "base/alloc.h"
#include "base/curves.h"
#include "base/noise.h"
#include "base/rng.h"

#include <math.h>
#include <string.h>

enum { KEY_WITHIN = 401, KEY_BEND_X, KEY_BEND_Y };

#define BEND 0.35f       // cells: deviation with which outlines wander about their cells
#define BEND_CELLS 1.7f  // size of the wandering
#define GRAIN_CELLS 0.8f // size of the largest grain that a cell cannot have
#define OCTAVE 0.7f      // of grain within a cell, against that of neighbouring cells
#define MOST_GRAIN 0.5f  // its deviation, share of the pigment
#define LOOK 3           // cells: radius in which the texture of the cells is measured

struct FlFineSheet {
    int ratio;
    FlSheet *fine;
    float *grain;           // of each fine cell: deviation 1 over the sheet
    float *bend_x, *bend_y; // displacement of a fine cell, cells
    float *rough;           // of each cell: deviation of the grain inside, share of its pigment
    float *rows, *square, *total, *sharp; // of each cell
};

/* ---- planes of the cells --------------------------------------------------------------------- */

static float cell_at(const float *plane, int width, int height, int i, int j)
{
    return plane[(size_t)CLAMP(j, 0, height - 1) * (size_t)width + (size_t)CLAMP(i, 0, width - 1)];
}

/* Interpolation makes peaks flatter: the mean of it over a cell is the cell's value again if the
 * cell's curvature is taken off before. */
static void sharpen(const float *plane, int width, int height, float *sharp)
{
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            const float at = plane[(size_t)j * (size_t)width + (size_t)i];
            const float around =
                cell_at(plane, width, height, i - 1, j) + cell_at(plane, width, height, i + 1, j) +
                cell_at(plane, width, height, i, j - 1) + cell_at(plane, width, height, i, j + 1);
            sharp[(size_t)j * (size_t)width + (size_t)i] = at + (4 * at - around) / 24;
        }
}

/* The mean over a square of cells; rows: scratch. */
static void square_mean(float *plane, int width, int height, int radius, float *rows)
{
    const float share = 1 / (float)((2 * radius + 1) * (2 * radius + 1));
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            float sum = 0;
            for (int k = -radius; k <= radius; k++)
                sum += cell_at(plane, width, height, i + k, j);
            rows[(size_t)j * (size_t)width + (size_t)i] = sum;
        }
#pragma omp parallel for schedule(static)
    for (int j = 0; j < height; j++)
        for (int i = 0; i < width; i++) {
            float sum = 0;
            for (int k = -radius; k <= radius; k++)
                sum += cell_at(rows, width, height, i, j + k);
            plane[(size_t)j * (size_t)width + (size_t)i] = sum * share;
        }
}

/* Stores the roughness of a plane, its deviation from cell to cell relative to the local mean, in
 * `rough`. */
static void find_roughness(FlFineSheet *fine, const float *plane, int width, int height)
{
    const size_t cells = (size_t)width * (size_t)height;
    float *mean = fine->sharp, *square = fine->square;
    memcpy(mean, plane, cells * sizeof *mean);
    square_mean(mean, width, height, 1, fine->rows);
    for (size_t i = 0; i < cells; i++)
        square[i] = (plane[i] - mean[i]) * (plane[i] - mean[i]);
    square_mean(square, width, height, LOOK, fine->rows);
    square_mean(mean, width, height, LOOK, fine->rows);
    for (size_t i = 0; i < cells; i++)
        fine->rough[i] = fminf(MOST_GRAIN, OCTAVE * sqrtf(square[i]) / (mean[i] + 1e-3f));
}

/* ---- the fine planes ------------------------------------------------------------------------- */

/* Makes the noise of the fine cells in coordinates of the cells, so that all ratios have the same.
 */
static void fill_noise(FlFineSheet *fine, uint64_t seed)
{
    const FlSheet *sheet = fine->fine;
    int octaves = 0;
    for (int r = fine->ratio; r > 1; r /= 2)
        octaves++;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < sheet->height; j++)
        for (int i = 0; i < sheet->width; i++) {
            const size_t at = (size_t)j * (size_t)sheet->width + (size_t)i;
            const float x = ((float)i + .5f) / (float)fine->ratio;
            const float y = ((float)j + .5f) / (float)fine->ratio;
            const float u = x / BEND_CELLS, v = y / BEND_CELLS;
            fine->grain[at] = 2 * fl_noise_octaves(fl_key(seed, KEY_WITHIN), x / GRAIN_CELLS,
                                                   y / GRAIN_CELLS, MAX(octaves, 1), OCTAVE);
            fine->bend_x[at] =
                2 * BEND * fl_noise_octaves(fl_key(seed, KEY_BEND_X), u, v, octaves + 1, .6f);
            fine->bend_y[at] =
                2 * BEND * fl_noise_octaves(fl_key(seed, KEY_BEND_Y), u, v, octaves + 1, .6f);
        }
}

/* A plane of cells on the fine grid, with grain as rough as said; below least is cut. */
static void refine(const FlFineSheet *fine, const FlSheet *sheet, const float *sharp, float least,
                   float *to)
{
    const int width = sheet->width, height = sheet->height;
    const float part = 1 / (float)fine->ratio;
#pragma omp parallel for schedule(static)
    for (int j = 0; j < fine->fine->height; j++)
        for (int i = 0; i < fine->fine->width; i++) {
            const size_t at = (size_t)j * (size_t)fine->fine->width + (size_t)i;
            const float x = ((float)i + .5f) * part - .5f + fine->bend_x[at];
            const float y = ((float)j + .5f) * part - .5f + fine->bend_y[at];
            const float smooth = fl_cubic_sample(sharp, width, height, x, y);
            const size_t cell =
                (size_t)(j / fine->ratio) * (size_t)width + (size_t)(i / fine->ratio);
            const float more = 1 + fine->rough[cell] * fine->grain[at];
            to[at] = fmaxf(least, smooth * fmaxf(0, more));
        }
}

static FlSheet *new_planes(int width, int height, int n_pigments, GError **error)
{
    const size_t cells = (size_t)width * (size_t)height;
    g_autoptr(FlSheet) sheet = g_new0(FlSheet, 1);
    sheet->width = width, sheet->height = height, sheet->n_pigments = n_pigments;
    if (!(sheet->relief = fl_alloc(cells, sizeof(float), "a sheet of paper", error)))
        return NULL;
    for (int k = 0; k < n_pigments; k++)
        if (!(sheet->settled[k] = fl_alloc(cells, sizeof(float), "pigment", error)))
            return NULL;
    return g_steal_pointer(&sheet);
}

static bool allocate(FlFineSheet *fine, const FlSheet *sheet, GError **error)
{
    const int width = sheet->width * fine->ratio, height = sheet->height * fine->ratio;
    const size_t cells = (size_t)sheet->width * (size_t)sheet->height;
    const size_t many = (size_t)width * (size_t)height;
    float **coarse[] = {&fine->rough, &fine->rows, &fine->square, &fine->total, &fine->sharp};
    float **finer[] = {&fine->grain, &fine->bend_x, &fine->bend_y};
    if (!(fine->fine = new_planes(width, height, sheet->n_pigments, error)))
        return false;
    for (size_t i = 0; i < G_N_ELEMENTS(coarse); i++)
        if (!(*coarse[i] = fl_alloc(cells, sizeof(float), "a sheet of paper", error)))
            return false;
    for (size_t i = 0; i < G_N_ELEMENTS(finer); i++)
        if (!(*finer[i] = fl_alloc(many, sizeof(float), "a sheet of paper", error)))
            return false;
    return true;
}

FlFineSheet *fl_fine_sheet_new(const FlSheet *sheet, int ratio, uint64_t seed, GError **error)
{
    g_autoptr(FlFineSheet) fine = g_new0(FlFineSheet, 1);
    fine->ratio = ratio;
    if (!allocate(fine, sheet, error))
        return NULL;
    if (ratio > 1)
        fill_noise(fine, seed);
    find_roughness(fine, sheet->relief, sheet->width, sheet->height);
    sharpen(sheet->relief, sheet->width, sheet->height, fine->sharp);
    refine(fine, sheet, fine->sharp, 0, fine->fine->relief);
    return g_steal_pointer(&fine);
}

void fl_fine_sheet_follow(FlFineSheet *fine, const FlSheet *sheet)
{
    const size_t cells = (size_t)sheet->width * (size_t)sheet->height;
    float *total = fine->total;
    memset(total, 0, cells * sizeof *total);
    for (int k = 0; k < sheet->n_pigments; k++)
        for (size_t i = 0; i < cells; i++)
            total[i] += sheet->floating[k][i] + sheet->settled[k][i];
    find_roughness(fine, total, sheet->width, sheet->height);
    for (int k = 0; k < sheet->n_pigments; k++) {
        for (size_t i = 0; i < cells; i++)
            total[i] = sheet->floating[k][i] + sheet->settled[k][i];
        sharpen(total, sheet->width, sheet->height, fine->sharp);
        refine(fine, sheet, fine->sharp, 0, fine->fine->settled[k]);
    }
}

FlSheet *fl_fine_sheet(FlFineSheet *fine)
{
    return fine->fine;
}

void fl_fine_sheet_free(FlFineSheet *fine)
{
    if (!fine)
        return;
    float *planes[] = {fine->grain, fine->bend_x, fine->bend_y, fine->rough,
                       fine->rows,  fine->square, fine->total,  fine->sharp};
    for (size_t i = 0; i < G_N_ELEMENTS(planes); i++)
        free(planes[i]);
    fl_sheet_free(fine->fine);
    g_free(fine);
}
