#include "base/noise.h"

#include "base/rng.h"

#include <math.h>

/** The slopes at the corners of a lattice cell, row by row. */
typedef struct Cell {
    uint64_t key;
    int32_t x, y;
    float slope[4][2];
} Cell;

/* The last cell of each key, or nearly each: whoever asks along a row stays in a cell for some
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
    if (cell->key != key || cell->x != ix || cell->y != iy || key == 0) // which a fresh cell has
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
