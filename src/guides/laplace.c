/*
 * Coarse levels first: each halves the one below, a coarse cell is fixed to the mean of its fixed
 * children, and its solution is where the next finer level starts. That alone is a good solution,
 * for what is left of the error is short-waved; the V-cycles take care of thin and winding shapes,
 * where coarse cells bridge gaps that the shape does not.
 */
#include "guides/laplace.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

/** A grid with a rim of outside cells, so that every cell has four neighbours. */
typedef struct Level {
    int width, height;
    size_t pitch;    // cells from a row to the next
    void *memory;    // of the arrays
    float *inverse;  // 1 / number of neighbours that are not outside, in free cells; else 0
    float *parents;  // weight of the coarse cells around a free one that are inside; else 0
    float *value[2]; // of either component; 0 outside
    float
        *source[2]; // neighbours * value - sum of the neighbours' values; NULL: 0, as on the finest
    uint8_t *cell;  // FlSolverCell
} Level;

enum {
    MAX_LEVELS = 16,
    SWEEPS_FIRST = 3, // per level on the way up to the finest
    SWEEPS_CYCLE = 2, // after each correction
};

typedef struct Grid {
    int n_levels;
    Level level[MAX_LEVELS];
    float low[2], high[2]; // of what is fixed
} Grid;

/** Frees the levels from the first-th on. */
static void drop_levels(Grid *grid, int first)
{
    for (int l = first; l < grid->n_levels; l++)
        free(grid->level[l].memory);
    grid->n_levels = MIN(grid->n_levels, first);
}

static void grid_clear(Grid *grid)
{
    drop_levels(grid, 0);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Grid, grid_clear)

static bool level_init(Level *level, int width, int height, bool finest, GError **error)
{
    const size_t pitch = (size_t)width + 2, n = ((size_t)height + 2) * pitch;
    const int planes = finest ? 4 : 6;
    float *memory = fl_alloc_scratch((size_t)planes * n + n / 4 + 1, sizeof *memory,
                                     "the diffusion of a flow", error);
    *level = (Level){width, height, pitch, memory};
    if (!memory)
        return false;
    level->inverse = memory;
    level->parents = memory + n;
    for (size_t k = 0; k < 2; k++) {
        level->value[k] = memory + (2 + k) * n;
        level->source[k] = finest ? NULL : memory + (4 + k) * n;
    }
    level->cell = (uint8_t *)(memory + (size_t)planes * n);
    return true;
}

/** Does something to a row of a level, from what is in another one. */
typedef void RowWork(const Level *level, const Level *other, int y);

/** Does it to every row; a small level is not worth even a team of one thread. */
static void for_rows(const Level *level, const Level *other, RowWork *work)
{
#pragma omp parallel for schedule(static) if (level->height > 64)
    for (int y = 0; y < level->height; y++)
        work(level, other, y);
}

/** The index of a cell; x and y may be in the rim. */
static size_t at(const Level *level, int x, int y)
{
    return (size_t)(y + 1) * level->pitch + (size_t)(x + 1);
}

/** A cell without neighbours stays as it is: its inverse is 0, like that of a fixed one. */
static void count_neighbours(const Level *level, const Level *other, int y)
{
    for (int x = 0; x < level->width; x++) {
        const uint8_t *cell = level->cell + at(level, x, y);
        const int n = (cell[-1] != 0) + (cell[1] != 0) + (cell[-(ptrdiff_t)level->pitch] != 0) +
                      (cell[level->pitch] != 0);
        if (*cell == FL_CELL_FREE && n > 0)
            level->inverse[at(level, x, y)] = 1.0f / (float)n;
    }
}

/** Makes the coarse cells of a row, each over four fine ones, any of which may be in the rim. A
 * cell is fixed to the mean of its fixed children, while all other values are 0 still. */
static void coarsen(const Level *coarse, const Level *fine, int y)
{
    for (int x = 0; x < coarse->width; x++) {
        const size_t c = at(coarse, x, y);
        int n = 0;
        for (int child = 0; child < 4; child++) {
            const size_t f = at(fine, 2 * x + child % 2, 2 * y + child / 2);
            coarse->cell[c] |= fine->cell[f];
            coarse->value[0][c] += fine->value[0][f];
            coarse->value[1][c] += fine->value[1][f];
            n += fine->cell[f] == FL_CELL_FIXED;
        }
        if (n > 0) {
            coarse->cell[c] = FL_CELL_FIXED;
            coarse->value[0][c] /= (float)n;
            coarse->value[1][c] /= (float)n;
        }
    }
}

/** The four coarse cells nearest to a fine one, nearest first, between which the coarse field is
 * bilinear with weights of 9, 3, 3 and 1. */
static void find_parents(const Level *coarse, int x, int y, size_t parents[4])
{
    const int column[2] = {x / 2, x / 2 + (x & 1 ? 1 : -1)};
    const int row[2] = {y / 2, y / 2 + (y & 1 ? 1 : -1)};
    for (int k = 0; k < 4; k++)
        parents[k] = at(coarse, column[k % 2], row[k / 2]);
}

/** The weight of those of a cell's parents that are in the shape. */
static void weigh_parents(const Level *fine, const Level *coarse, int y)
{
    const uint8_t *cell = coarse->cell;
    for (int x = 0; x < fine->width; x++) {
        const size_t f = at(fine, x, y);
        size_t p[4];
        if (!(fine->inverse[f] > 0))
            continue;
        find_parents(coarse, x, y, p);
        fine->parents[f] = (float)(9 * (cell[p[0]] != 0) + 3 * (cell[p[1]] != 0) +
                                   3 * (cell[p[2]] != 0) + (cell[p[3]] != 0));
    }
}

/** The finest level, with the field where it is fixed. */
static void load(Grid *grid, const uint8_t *cell, const float *field)
{
    const Level *level = &grid->level[0];
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++, cell++, field += 2) {
            const size_t c = at(level, x, y);
            level->cell[c] = *cell;
            for (int k = 0; k < 2 && *cell == FL_CELL_FIXED; k++) {
                level->value[k][c] = field[k];
                grid->low[k] = MIN(grid->low[k], field[k]);
                grid->high[k] = MAX(grid->high[k], field[k]);
            }
        }
}

static bool grid_init(Grid *grid, const uint8_t *cell, int width, int height, const float *field,
                      GError **error)
{
    *grid = (Grid){.low = {INFINITY, INFINITY}, .high = {-INFINITY, -INFINITY}};
    for (; grid->n_levels < MAX_LEVELS; width = (width + 1) / 2, height = (height + 1) / 2) {
        Level *level = &grid->level[grid->n_levels++];
        const bool finest = grid->n_levels == 1;
        if (!level_init(level, width, height, finest, error))
            return false;
        if (finest)
            load(grid, cell, field);
        else
            for_rows(level, level - 1, coarsen);
        for_rows(level, NULL, count_neighbours);
        if (!finest)
            for_rows(level - 1, level, weigh_parents);
        if (width == 1 && height == 1)
            break;
    }
    return true;
}

static float source_at(const Level *level, int k, size_t c)
{
    return level->source[k] ? level->source[k][c] : 0;
}

/** A number and the values around a cell, added in this order. */
static float add_around(float sum, const Level *level, int k, size_t c)
{
    const float *v = level->value[k] + c;
    return sum + v[-1] + v[1] + v[-(ptrdiff_t)level->pitch] + v[level->pitch];
}

/** Sets the free cells of one colour of a chessboard to the mean of their neighbours. */
static void relax_colour(const Level *level, int first, int y)
{
    for (int x = first; x < level->width; x += 2) {
        const size_t c = at(level, x, y);
        if (!(level->inverse[c] > 0))
            continue;
        for (int k = 0; k < 2; k++)
            level->value[k][c] =
                (add_around(0, level, k, c) + source_at(level, k, c)) * level->inverse[c];
    }
}

static void relax_red(const Level *level, const Level *other, int y)
{
    relax_colour(level, y & 1, y);
}

static void relax_black(const Level *level, const Level *other, int y)
{
    relax_colour(level, !(y & 1), y);
}

/** Red-black sweeps of Gauss and Seidel: a colour reads the other only, so threads may share it. */
static void relax(const Level *level, int sweeps)
{
    for (int sweep = 0; sweep < sweeps; sweep++) {
        for_rows(level, NULL, relax_red);
        for_rows(level, NULL, relax_black);
    }
}

/** Adds to the free cells of a fine row (which may be 0) the coarse field. */
static void refine(const Level *fine, const Level *coarse, int y)
{
    for (int x = 0; x < fine->width; x++) {
        const size_t f = at(fine, x, y);
        size_t p[4];
        if (!(fine->parents[f] > 0))
            continue;
        find_parents(coarse, x, y, p);
        for (int k = 0; k < 2; k++) {
            const float *v = coarse->value[k];
            fine->value[k][f] +=
                (9 * v[p[0]] + 3 * v[p[1]] + 3 * v[p[2]] + v[p[3]]) / fine->parents[f];
        }
    }
}

/** Makes a row of the coarse problem whose solution is the correction of the fine one. */
static void restrict_residual(const Level *coarse, const Level *fine, int y)
{
    for (int x = 0; x < coarse->width; x++)
        for (int k = 0; k < 2; k++) {
            const size_t c = at(coarse, x, y);
            coarse->value[k][c] = coarse->source[k][c] = 0;
            for (int child = 0; child < 4; child++) {
                const size_t f = at(fine, 2 * x + child % 2, 2 * y + child / 2);
                if (fine->inverse[f] > 0)
                    coarse->source[k][c] += add_around(source_at(fine, k, f), fine, k, f) -
                                            fine->value[k][f] / fine->inverse[f];
            }
        }
}

static void v_cycle(const Grid *grid)
{
    const Level *level = grid->level;
    for (int l = 1; l < grid->n_levels; l++) {
        for_rows(&level[l], &level[l - 1], restrict_residual);
        if (l < grid->n_levels - 1)
            relax(&level[l], 1);
    }
    for (int l = grid->n_levels - 2; l >= 0; l--) {
        for_rows(&level[l], &level[l + 1], refine);
        relax(&level[l], SWEEPS_CYCLE);
    }
}

/** Clamps the result: the remaining error must not break the maximum principle. */
static void store(const Grid *grid, float *field)
{
    const Level *level = &grid->level[0];
    for (int y = 0; y < level->height; y++)
        for (int x = 0; x < level->width; x++)
            for (int k = 0; k < 2; k++) {
                const size_t c = at(level, x, y);
                const float clamped = MAX(grid->low[k], MIN(grid->high[k], level->value[k][c]));
                *field++ = level->cell[c] ? clamped : 0.0f;
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
    const Level *level = grid.level;
    for (int l = grid.n_levels - 2; l >= 0; l--) {
        for_rows(&level[l], &level[l + 1], refine);
        relax(&level[l], SWEEPS_FIRST);
    }
    for (int cycle = 0; cycle < cycles; cycle++)
        v_cycle(&grid);
    drop_levels(&grid, 1); // the field may take memory only from here on
    store(&grid, field);
    return true;
}
