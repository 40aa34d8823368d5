#include "base/noise.h"

#include "base/cpu.h"
#include "base/curves.h"
#include "base/rng.h"
#include <math.h>
#include <stddef.h>
#include <string.h>

/** The slopes at the corners of a lattice cell, row by row. */
typedef struct Cell {
    uint64_t key;
    int32_t x, y;
    float slope[4][2];
} Cell;

/* The last cell of each key, or nearly each: a query along a row stays in a cell for some
 * steps, and hashing its corners takes longer than all else. */
#define MEMO 256
static _Thread_local Cell memo[MEMO];

static void hash_corner(uint64_t key, int32_t ix, int32_t iy, float slope[2])
{
    const uint64_t bits = fl_key(key, (uint64_t)(uint32_t)ix << 32 | (uint32_t)iy);
    slope[0] = (float)(int16_t)(bits >> 48) * 0x1p-15f;
    slope[1] = (float)(int16_t)(bits >> 32) * 0x1p-15f;
}

static void hash_cell(uint64_t key, int32_t ix, int32_t iy, Cell *cell)
{
    *cell = (Cell){.key = key, .x = ix, .y = iy};
    for (int k = 0; k < 4; k++)
        hash_corner(key, ix + k % 2, iy + k / 2, cell->slope[k]);
}

static const Cell *cell_at(uint64_t key, int32_t ix, int32_t iy)
{
    Cell *cell = &memo[key % MEMO];
    if (cell->key != key || cell->x != ix || cell->y != iy || key == 0) // key of an unused cell
        hash_cell(key, ix, iy, cell);
    return cell;
}

static float rise(const float slope[2], float dx, float dy)
{
    return slope[0] * dx + slope[1] * dy;
}

static float ease(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

static float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

float fl_noise(uint64_t key, float x, float y)
{
    const float fx = floorf(x), fy = floorf(y);
    const int32_t ix = (int32_t)fx, iy = (int32_t)fy;
    const float dx = x - fx, dy = y - fy, tx = ease(dx);
    const Cell *cell = cell_at(key, ix, iy);
    const float upper = mix(rise(cell->slope[0], dx, dy), rise(cell->slope[1], dx - 1, dy), tx);
    const float lower =
        mix(rise(cell->slope[2], dx, dy - 1), rise(cell->slope[3], dx - 1, dy - 1), tx);
    return 2.0f * mix(upper, lower, ease(dy)); // the standard deviation is then about 0.5
}

float fl_noise_octaves(uint64_t key, float x, float y, int octaves, float gain)
{
    float sum = 0, weight = 1, squares = 0;
    for (int o = 0; o < octaves; o++) {
        sum += weight * fl_noise(fl_key(key, (uint64_t)o), x, y);
        squares += weight * weight;
        weight *= gain;
        x *= 2, y *= 2;
    }
    return sum / sqrtf(squares);
}

/* ---- rows ----------------------------------------------------------------------------------- */

/* Positions within their cells, and the slopes at the corners of these cells. */
typedef struct Row {
    int32_t ix[FL_NOISE_ROW], iy[FL_NOISE_ROW];
    float dx[FL_NOISE_ROW], dy[FL_NOISE_ROW];
    float slope[4][2][FL_NOISE_ROW];
} Row;

/* A cast truncates, and is vectorised; for negative numbers 1 is subtracted to get the floor. */
static void find_cells(const float *restrict x, const float *restrict y, int n, Row *restrict row)
{
    for (int i = 0; i < n; i++) {
        const int32_t ix = (int32_t)x[i], iy = (int32_t)y[i];
        row->ix[i] = ix - (x[i] < (float)ix);
        row->iy[i] = iy - (y[i] < (float)iy);
        row->dx[i] = x[i] - (float)row->ix[i];
        row->dy[i] = y[i] - (float)row->iy[i];
    }
}

/* Two corners are those of the cell before where it is the one on the left, as along a row. */
static void move_cell(uint64_t key, int32_t ix, int32_t iy, Cell *cell)
{
    if (ix != cell->x + 1 || iy != cell->y) {
        hash_cell(key, ix, iy, cell);
        return;
    }
    cell->x = ix;
    memcpy(cell->slope[0], cell->slope[1], sizeof cell->slope[0]);
    memcpy(cell->slope[2], cell->slope[3], sizeof cell->slope[0]);
    hash_corner(key, ix + 1, iy, cell->slope[1]);
    hash_corner(key, ix + 1, iy + 1, cell->slope[3]);
}

static void find_slopes(uint64_t key, int n, Row *row)
{
    Cell cell;
    if (n > 0)
        hash_cell(key, row->ix[0], row->iy[0], &cell);
    for (int i = 0; i < n; i++) {
        if (row->ix[i] != cell.x || row->iy[i] != cell.y)
            move_cell(key, row->ix[i], row->iy[i], &cell);
        for (int k = 0; k < 4; k++)
            row->slope[k][0][i] = cell.slope[k][0], row->slope[k][1][i] = cell.slope[k][1];
    }
}

static float row_rise(const Row *row, int corner, int i, float dx, float dy)
{
    return row->slope[corner][0][i] * dx + row->slope[corner][1][i] * dy;
}

static void mix_slopes(const Row *restrict row, int n, float *restrict noise)
{
    for (int i = 0; i < n; i++) {
        const float dx = row->dx[i], dy = row->dy[i], tx = ease(dx);
        const float upper = mix(row_rise(row, 0, i, dx, dy), row_rise(row, 1, i, dx - 1, dy), tx);
        const float lower =
            mix(row_rise(row, 2, i, dx, dy - 1), row_rise(row, 3, i, dx - 1, dy - 1), tx);
        noise[i] = 2.0f * mix(upper, lower, ease(dy));
    }
}

static inline void find_row(uint64_t key, const float *x, const float *y, int n, float *noise)
{
    Row row;
    find_cells(x, y, n, &row);
    find_slopes(key, n, &row);
    mix_slopes(&row, n, noise);
}

FL_FOR_EACH_CPU(run_row, find_row,
                (uint64_t key, const float *x, const float *y, int n, float *noise),
                (key, x, y, n, noise))

void fl_noise_row(uint64_t key, const float *x, const float *y, int n, float *noise)
{
    run_row(key, x, y, n, noise);
}

void fl_noise_octaves_row(uint64_t key, const float *x, const float *y, int n, int octaves,
                          float gain, float *noise)
{
    float at_x[FL_NOISE_ROW], at_y[FL_NOISE_ROW], one[FL_NOISE_ROW];
    float weight = 1, squares = 0;
    memcpy(at_x, x, (size_t)n * sizeof *x);
    memcpy(at_y, y, (size_t)n * sizeof *y);
    memset(noise, 0, (size_t)n * sizeof *noise);
    for (int o = 0; o < octaves; o++) {
        fl_noise_row(fl_key(key, (uint64_t)o), at_x, at_y, n, one);
        for (int i = 0; i < n; i++)
            noise[i] += weight * one[i], at_x[i] *= 2, at_y[i] *= 2;
        squares += weight * weight;
        weight *= gain;
    }
    for (int i = 0; i < n; i++)
        noise[i] /= sqrtf(squares);
}

/* One fibre: a line that turns a little all the way, as wide as a px. Turned without sin and cos,
   whose last bit differs between C libraries. */
void fl_fibre_draw(float *grid, int width, int height, float x, float y, const FlFibre *fibre,
                   FlRng *rng)
{
    const float scale = fibre->scale;
    float dx = fl_rng_float(rng) - 0.5f, dy = fl_rng_float(rng) - 0.5f;
    const float length = fibre->length_px * scale, curl = fibre->curl;
    float turn = (fl_rng_float(rng) - 0.5f) * 0.05f * curl;
    const float strength = 0.4f + 0.6f * fl_rng_float(rng);
    const int steps = (int)(length * (0.4f + 1.2f * fl_rng_float(rng)));
    const float radius = 0.5f * scale * (0.6f + 0.6f * fl_rng_float(rng));
    const int reach = (int)radius + 1;
    for (int i = 0; i < steps; i++) {
        const float norm = 1 / sqrtf(dx * dx + dy * dy + 1e-12f);
        dx *= norm, dy *= norm;
        x += dx, y += dy;
        turn = fl_clamp(turn + (fl_rng_float(rng) - 0.5f) * 0.03f * curl, -0.08f, 0.08f);
        const float turned = dx - turn * dy;
        dy += turn * dx, dx = turned;
        for (int j = (int)y - reach; j <= (int)y + reach; j++)
            for (int k = (int)x - reach; k <= (int)x + reach; k++) {
                if (j < 0 || k < 0 || j >= height || k >= width)
                    continue;
                const float ex = (float)k - x, ey = (float)j - y;
                const float near = strength * (1 - (ex * ex + ey * ey) / (radius * radius + 1));
                float *cell = &grid[(size_t)j * width + k];
                *cell = near > *cell ? near : *cell;
            }
    }
}
