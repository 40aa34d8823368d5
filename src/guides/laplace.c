/*
 * Coarse levels first: each halves the one below, a coarse cell is fixed to the mean of its fixed
 * children, and its solution is where the next finer level starts. That alone is a good solution,
 * for what is left of the error is short-waved; the V-cycles take care of thin and winding shapes,
 * where coarse cells bridge gaps that the shape does not.
 */
#include "guides/laplace.h"

#include <math.h>
#include <string.h>

typedef float Pair __attribute__((vector_size(8)));

/** A grid with a rim of outside cells, so that every cell has four neighbours; (width + 2) *
 * (height + 2). */
typedef struct Level {
    int width, height;
    size_t stride;
    uint8_t *cell;  // FlCell
    float *inverse; // 1 / number of neighbours that are not outside, in free cells; else 0
    Pair *value;    // 0 outside
    Pair *source;   // right-hand side: neighbours * value - sum of the neighbours' values
} Level;

enum {
    MAX_LEVELS = 16,
    SWEEPS_FIRST = 3, // per level on the way up to the finest
    SWEEPS_CYCLE = 2, // after each correction
};

typedef struct Grid {
    int n_levels;
    Level level[MAX_LEVELS];
} Grid;

static void grid_clear(Grid *grid)
{
    for (int l = 0; l < grid->n_levels; l++) {
        g_free(grid->level[l].cell);
        g_free(grid->level[l].inverse);
        g_free(grid->level[l].value);
        g_free(grid->level[l].source);
    }
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Grid, grid_clear)

static bool level_init(Level *level, int width, int height)
{
    const size_t n = (size_t)(width + 2) * (height + 2);
    *level = (Level){.width = width, .height = height, .stride = width + 2};
    level->cell = g_try_new0(uint8_t, n);
    level->inverse = g_try_new0(float, n);
    level->value = g_try_new0(Pair, n);
    level->source = g_try_new0(Pair, n);
    return level->cell && level->inverse && level->value && level->source;
}

static size_t cell_index(const Level *level, int x, int y)
{
    return (y + 1) * level->stride + x + 1;
}

/** A cell without neighbours stays as it is: its inverse is 0, like that of a fixed one. */
static void count_neighbours(Level *level)
{
    const ptrdiff_t s = (ptrdiff_t)level->stride;
    for (int y = 0; y < level->height; y++) {
        const uint8_t *cell = level->cell + cell_index(level, 0, y);
        float *inverse = level->inverse + cell_index(level, 0, y);
        for (int x = 0; x < level->width; x++) {
            const uint8_t *c = cell + x;
            const int n = (c[-1] != 0) + (c[1] != 0) + (c[-s] != 0) + (c[s] != 0);
            inverse[x] = *c == FL_CELL_FREE && n > 0 ? 1.0f / (float)n : 0.0f;
        }
    }
}

/** The coarse cell over four fine ones; any of the four may be in the rim of the fine level. */
static void coarsen(const Level *fine, Level *coarse)
{
    for (int y = 0; y < coarse->height; y++) {
        for (int x = 0; x < coarse->width; x++) {
            const size_t f = cell_index(fine, 2 * x, 2 * y), c = cell_index(coarse, x, y);
            const size_t child[4] = {f, f + 1, f + fine->stride, f + fine->stride + 1};
            Pair sum = {0, 0};
            int n_fixed = 0;
            for (int k = 0; k < 4; k++) {
                coarse->cell[c] |= fine->cell[child[k]];
                if (fine->cell[child[k]] == FL_CELL_FIXED)
                    sum += fine->value[child[k]], n_fixed++;
            }
            if (n_fixed > 0)
                coarse->cell[c] = FL_CELL_FIXED, coarse->value[c] = sum / (float)n_fixed;
        }
    }
}

static bool grid_init(Grid *grid, const uint8_t *cell, int width, int height, const float *field,
                      GError **error)
{
    for (; grid->n_levels < MAX_LEVELS; width = (width + 1) / 2, height = (height + 1) / 2) {
        Level *level = &grid->level[grid->n_levels++];
        if (!level_init(level, width, height)) {
            g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY,
                        "not enough memory to diffuse a flow of %dx%d pixels", width, height);
            return false;
        }
        for (int y = 0; y < height && grid->n_levels == 1; y++) {
            const size_t row = cell_index(level, 0, y), p = y * (size_t)width;
            memcpy(level->cell + row, cell + p, width);
            for (int x = 0; x < width; x++)
                if (cell[p + x] == FL_CELL_FIXED)
                    level->value[row + x] = (Pair){field[2 * (p + x)], field[2 * (p + x) + 1]};
        }
        if (grid->n_levels > 1)
            coarsen(level - 1, level);
        count_neighbours(level);
        if (width == 1 && height == 1)
            break;
    }
    return true;
}

/** One red-black sweep of Gauss and Seidel: a colour reads the other only, so threads may share it.
 */
static void relax(Level *level)
{
    const ptrdiff_t s = (ptrdiff_t)level->stride;
    for (int colour = 0; colour < 2; colour++) {
#pragma omp parallel for schedule(static) if (level->height > 64)
        for (int y = 0; y < level->height; y++) {
            const size_t row = cell_index(level, 0, y);
            const float *inverse = level->inverse + row;
            const Pair *source = level->source + row;
            Pair *value = level->value + row;
            for (int x = (y + colour) & 1; x < level->width; x += 2)
                if (inverse[x] > 0.0f) {
                    const Pair sum = value[x - 1] + value[x + 1] + value[x - s] + value[x + s];
                    value[x] = (sum + source[x]) * inverse[x];
                }
        }
    }
}

/** Where the two nearest coarse cells along an axis are, for a fine coordinate, nearest first. */
static ptrdiff_t other_parent(int fine, ptrdiff_t stride)
{
    return fine & 1 ? stride : -stride;
}

/** The coarse field at a fine cell: bilinear between the coarse cells that are in the shape. */
static Pair interpolate(const Level *coarse, int x, int y)
{
    const ptrdiff_t c = (ptrdiff_t)cell_index(coarse, x / 2, y / 2);
    const ptrdiff_t dx = other_parent(x, 1), dy = other_parent(y, (ptrdiff_t)coarse->stride);
    const ptrdiff_t at[4] = {c, c + dx, c + dy, c + dx + dy};
    const float weight[4] = {9, 3, 3, 1};
    Pair sum = {0, 0};
    float norm = 0.0f;
    for (int k = 0; k < 4; k++)
        if (coarse->cell[at[k]]) {
            sum += weight[k] * coarse->value[at[k]];
            norm += weight[k];
        }
    return sum / norm;
}

/** Adds to the free cells of the fine level (which may be 0) the coarse field. */
static void refine(const Level *coarse, Level *fine)
{
#pragma omp parallel for schedule(static) if (fine->height > 64)
    for (int y = 0; y < fine->height; y++) {
        const size_t row = cell_index(fine, 0, y);
        for (int x = 0; x < fine->width; x++)
            if (fine->inverse[row + x] > 0.0f)
                fine->value[row + x] += interpolate(coarse, x, y);
    }
}

static Pair residual(const Level *level, size_t c)
{
    if (!(level->inverse[c] > 0.0f))
        return (Pair){0, 0};
    const Pair *v = level->value + c;
    const ptrdiff_t s = (ptrdiff_t)level->stride;
    return level->source[c] + v[-1] + v[1] + v[-s] + v[s] - v[0] / level->inverse[c];
}

/** Makes the coarse problem whose solution is the correction of the fine one. */
static void restrict_residual(const Level *fine, Level *coarse)
{
    const size_t bytes = coarse->stride * (coarse->height + 2) * sizeof(Pair);
    memset(coarse->value, 0, bytes);
#pragma omp parallel for schedule(static) if (coarse->height > 64)
    for (int y = 0; y < coarse->height; y++)
        for (int x = 0; x < coarse->width; x++) {
            const size_t f = cell_index(fine, 2 * x, 2 * y), c = cell_index(coarse, x, y);
            coarse->source[c] = residual(fine, f) + residual(fine, f + 1) +
                                residual(fine, f + fine->stride) +
                                residual(fine, f + fine->stride + 1);
        }
}

static void v_cycle(Grid *grid)
{
    for (int l = 1; l < grid->n_levels; l++) {
        restrict_residual(&grid->level[l - 1], &grid->level[l]);
        if (l < grid->n_levels - 1)
            relax(&grid->level[l]);
    }
    for (int l = grid->n_levels - 2; l >= 0; l--) {
        refine(&grid->level[l + 1], &grid->level[l]);
        for (int sweep = 0; sweep < SWEEPS_CYCLE; sweep++)
            relax(&grid->level[l]);
    }
}

/** What remains of the error must not break the maximum principle. */
static void store(const Level *level, float *field)
{
    float low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (int y = 0; y < level->height; y++)
        for (size_t c = cell_index(level, 0, y), end = c + level->width; c < end; c++)
            for (int k = 0; k < 2 && level->cell[c] == FL_CELL_FIXED; k++) {
                low[k] = MIN(low[k], level->value[c][k]);
                high[k] = MAX(high[k], level->value[c][k]);
            }
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++) {
            const size_t c = cell_index(level, x, y);
            for (int k = 0; k < 2; k++)
                *field++ = level->cell[c] ? CLAMP(level->value[c][k], low[k], high[k]) : 0.0f;
        }
}

bool fl_laplace_solve(const uint8_t *cell, int width, int height, int cycles, float *field,
                      GError **error)
{
    if (!memchr(cell, FL_CELL_FIXED, (size_t)width * height)) {
        memset(field, 0, 2 * (size_t)width * height * sizeof *field);
        return true;
    }
    g_auto(Grid) grid = {0};
    if (!grid_init(&grid, cell, width, height, field, error))
        return false;
    for (int l = grid.n_levels - 2; l >= 0; l--) {
        refine(&grid.level[l + 1], &grid.level[l]);
        for (int sweep = 0; sweep < SWEEPS_FIRST; sweep++)
            relax(&grid.level[l]);
    }
    for (int cycle = 0; cycle < cycles; cycle++)
        v_cycle(&grid);
    store(&grid.level[0], field);
    return true;
}
