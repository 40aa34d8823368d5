/*
 * Coarse levels first: each halves the one below, a coarse cell is fixed to the mean of its fixed
 * children, and its solution is where the next finer level starts. That alone is a good solution,
 * for what is left of the error is short-waved; the V-cycles take care of thin and winding shapes,
 * where coarse cells bridge gaps that the shape does not.
 *
 * A sweep goes over the cells of one colour of a chessboard. So a row is stored in two halves, its
 * even cells and then its odd ones: in each half the cells of a colour and all that is on one side
 * of them are without gaps.
 */
#include "guides/laplace.h"

#include "base/alloc.h"
#include "base/rect.h"
#include "base/row_kernels.h"
#include <math.h>
#include <string.h>

/**
 * A grid with a rim of outside cells, so that every cell has four neighbours. An array has two
 * halves for each of height + 2 rows. The finest level has no sources, so that half a row of zeros
 * serves all its rows.
 */
typedef struct Level {
    int width, height;
    bool is_finest;
    int pairs;        // of cells in half a row; the last may be beyond the width, outside
    size_t half;      // cells from half a row to the next; the last is of the rim
    FlColumns *span;  // of each row: where in its halves cells are; else all arrays are 0
    void *memory;     // of the arrays
    float *inverse;   // 1 / number of neighbours that are not outside, in free cells; else 0
    float *parents;   // weight of the coarse cells around a free one that are inside; else 0
    float *value[2];  // of either component; 0 outside
    float *source[2]; // right-hand side: neighbours * value - sum of the neighbours' values
    uint8_t *cell;    // FlSolverCell
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
    for (int l = first; l < grid->n_levels; l++) {
        free(grid->level[l].memory);
        g_free(grid->level[l].span);
    }
    grid->n_levels = MIN(grid->n_levels, first);
}

static void grid_clear(Grid *grid)
{
    drop_levels(grid, 0);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Grid, grid_clear)

/* Loops are slow where vectors end, or begin anywhere: pairs are in fours, halves in sixteens. */
static bool level_init(Level *level, int width, int height, bool finest, GError **error)
{
    const int pairs = (width + 15) / 16 * 4;
    const size_t half = ((size_t)pairs * 2 + 16) / 16 * 16, n = ((size_t)height + 2) * 2 * half;
    const size_t sources = finest ? half : 2 * n;
    void *scratch = fl_alloc_scratch(4 * n + sources + n / 4 + 16, sizeof(float),
                                     "the diffusion of a flow", error);
    *level = (Level){width, height, finest, pairs, half, .memory = scratch};
    if (!scratch)
        return false;
    level->span = g_new0(FlColumns, height);
    float *memory = (float *)(((uintptr_t)scratch + 63) / 64 * 64);
    level->inverse = memory;
    level->parents = memory + n;
    for (size_t k = 0; k < 2; k++) {
        level->value[k] = memory + (2 + k) * n;
        level->source[k] = memory + 4 * n + (finest ? 0 : k * n);
    }
    level->cell = (uint8_t *)(memory + 4 * n + sources);
    return true;
}

/** The smallest span with some places of half a row that loops are fast in. */
static FlColumns span_around(const Level *level, int first, int last)
{
    return (FlColumns){first / 16 * 16, MIN((last + 7) / 8 * 8, 2 * level->pairs)};
}

/** Finds the columns of each row of the finest level that have cells. */
static void find_spans(const Level *level, const uint8_t *cell)
{
    g_auto(FlArea) area = {0};
    fl_area_init(&area, cell, level->width, level->height);
    for (int y = 0; y < area.box.height; y++) {
        const FlColumns row = fl_area_row(&area, y);
        if (row.first < row.last)
            level->span[area.box.y + y] =
                span_around(level, (area.box.x + row.first) / 2, (area.box.x + row.last + 1) / 2);
    }
}

/** Finds the columns of each row of a coarse level that have cells. */
static void halve_spans(const Level *coarse, const Level *fine)
{
    for (int y = 0; y < coarse->height; y++) {
        const FlColumns upper = fine->span[2 * y];
        const FlColumns lower = 2 * y + 1 < fine->height ? fine->span[2 * y + 1] : upper;
        const bool none = upper.first >= upper.last, one = none || lower.first >= lower.last;
        const FlColumns both = {MIN(upper.first, lower.first), MAX(upper.last, lower.last)};
        const FlColumns row = !one ? both : none ? lower : upper;
        if (row.first < row.last)
            coarse->span[y] = span_around(coarse, row.first / 2, (row.last + 1) / 2);
    }
}

/** Does something to a row of a level, if it has cells, from what is in another one. */
typedef void RowWork(const Level *level, const Level *other, int y);

static void do_row(const Level *level, const Level *other, RowWork *work, int y)
{
    if (level->span[y].first < level->span[y].last)
        work(level, other, y);
}

/** Does it to every row; a small level is not worth even a team of one thread. */
static void for_rows(const Level *level, const Level *other, RowWork *work)
{
    if (level->height > 64) {
#pragma omp parallel for schedule(static)
        for (int y = 0; y < level->height; y++)
            do_row(level, other, work, y);
    } else {
        for (int y = 0; y < level->height; y++)
            do_row(level, other, work, y);
    }
}

/** The index of the first even or odd cell of a row; y may be in the rim. */
static size_t half_row(const Level *level, int odd, int y)
{
    return ((size_t)(y + 1) * 2 + (size_t)odd) * level->half;
}

/** The indices of the first cell of half a row and of its neighbours; the right one follows the
 * left. */
typedef struct Cross {
    size_t own, left, above, below;
} Cross;

static Cross cross_at(const Level *level, int odd, int y)
{
    return (Cross){half_row(level, odd, y), half_row(level, !odd, y) - (size_t)!odd,
                   half_row(level, odd, y - 1), half_row(level, odd, y + 1)};
}

/** A cell without neighbours stays as it is: its inverse is 0, like that of a fixed one. */
static void count_neighbours(const Level *level, const Level *other, int y)
{
    const FlColumns span = level->span[y];
    for (int odd = 0; odd < 2; odd++) {
        const Cross at = cross_at(level, odd, y);
        const uint8_t *own = level->cell + at.own, *beside = level->cell + at.left;
        const uint8_t *above = level->cell + at.above, *below = level->cell + at.below;
        float *restrict inverse = level->inverse + at.own;
        for (int i = span.first; i < span.last; i++) {
            const int n =
                (beside[i] != 0) + (beside[i + 1] != 0) + (above[i] != 0) + (below[i] != 0);
            const float free = own[i] == FL_CELL_FREE && n > 0;
            inverse[i] = free / (float)MAX(n, 1);
        }
    }
}

/** Fixes a coarse cell to the mean of its fixed children, when all other values are 0 still. The
 * first child is given; the others follow, by halves of rows. */
static void fix(const Level *coarse, size_t c, const Level *fine, size_t child)
{
    int n = 0;
    for (int k = 0; k < 4; k++, child += fine->half) {
        coarse->value[0][c] += fine->value[0][child];
        coarse->value[1][c] += fine->value[1][child];
        n += fine->cell[child] == FL_CELL_FIXED;
    }
    coarse->value[0][c] /= (float)n;
    coarse->value[1][c] /= (float)n;
}

/** Makes the coarse cells of a row, each over four fine ones, any of which may be in the rim. */
static void coarsen(const Level *coarse, const Level *fine, int y)
{
    const size_t h = fine->half, first = (size_t)coarse->span[y].first;
    const int end = MIN(2 * coarse->span[y].last, coarse->width);
    for (int odd = 0; odd < 2; odd++) {
        size_t c = half_row(coarse, odd, y) + first;
        size_t f = half_row(fine, 0, 2 * y) + odd + 2 * first;
        for (int x = 2 * (int)first + odd; x < end; x += 2, c++, f += 2) {
            const uint8_t *child = fine->cell + f;
            coarse->cell[c] = child[0] | child[h] | child[2 * h] | child[3 * h];
            if (coarse->cell[c] & FL_CELL_FIXED) {
                coarse->cell[c] = FL_CELL_FIXED;
                fix(coarse, c, fine, f);
            }
        }
    }
}

/** The four coarse cells nearest to each cell of half a fine row, nearest first: those of its even
 * cells and those of the odd ones. */
static void find_parents(const Level *coarse, int odd, int y, size_t parents[2][4])
{
    const int row[2] = {y / 2, y & 1 ? y / 2 + 1 : y / 2 - 1};
    for (int k = 0; k < 2; k++) {
        const size_t evens = half_row(coarse, 0, row[k]), odds = half_row(coarse, 1, row[k]);
        parents[0][2 * k] = evens;
        parents[0][2 * k + 1] = odd ? odds : odds - 1;
        parents[1][2 * k] = odds;
        parents[1][2 * k + 1] = odd ? evens + 1 : evens;
    }
}

/** The weight of those of a cell's parents that are in the shape, between which the coarse field is
 * bilinear. */
static int weight_of(const uint8_t *cell, const size_t parents[4], int i)
{
    cell += i;
    return 9 * (cell[parents[0]] != 0) + 3 * (cell[parents[1]] != 0) + 3 * (cell[parents[2]] != 0) +
           (cell[parents[3]] != 0);
}

static void weigh_parents(const Level *fine, const Level *coarse, int y)
{
    for (int odd = 0; odd < 2; odd++) {
        const float *inverse = fine->inverse + half_row(fine, odd, y);
        float *restrict weight = fine->parents + half_row(fine, odd, y);
        size_t at[2][4];
        find_parents(coarse, odd, y, at);
        for (int i = fine->span[y].first / 2; i < fine->span[y].last / 2; i++) {
            const int even = weight_of(coarse->cell, at[0], i);
            const int next = weight_of(coarse->cell, at[1], i);
            weight[2 * i] = inverse[2 * i] > 0 ? (float)even : 0.0f;
            weight[2 * i + 1] = inverse[2 * i + 1] > 0 ? (float)next : 0.0f;
        }
    }
}

/** A row of the finest level, with the field where it is fixed. */
static void load_row(Grid *grid, int y, const uint8_t *cell, const float *field)
{
    const Level *level = &grid->level[0];
    for (int x = 2 * level->span[y].first; x < MIN(2 * level->span[y].last, level->width); x++) {
        const size_t c = half_row(level, x & 1, y) + (size_t)(x / 2);
        level->cell[c] = cell[x];
        for (int k = 0; k < 2 && cell[x] == FL_CELL_FIXED; k++) {
            const float value = field[2 * x + k];
            level->value[k][c] = value;
            grid->low[k] = MIN(grid->low[k], value);
            grid->high[k] = MAX(grid->high[k], value);
        }
    }
}

/** The finest level. */
static void load(Grid *grid, const uint8_t *cell, const float *field)
{
    const Level *level = &grid->level[0];
    find_spans(level, cell);
    for (int y = 0; y < level->height; y++)
        if (level->span[y].first < level->span[y].last)
            load_row(grid, y, cell + y * (size_t)level->width,
                     field + 2 * y * (size_t)level->width);
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
            halve_spans(level, level - 1);
        if (!finest)
            for_rows(level, level - 1, coarsen);
        for_rows(level, NULL, count_neighbours);
        if (!finest)
            for_rows(level - 1, level, weigh_parents);
        if (width == 1 && height == 1)
            break;
    }
    return true;
}

/** From a place of half a row on. */
static FlStencil stencil_at(const Level *level, int component, int odd, int y, size_t first)
{
    Cross at = cross_at(level, odd, y);
    at.own += first, at.left += first, at.above += first, at.below += first;
    float *value = level->value[component];
    return (FlStencil){.value = value + at.own,
                       .beside = value + at.left,
                       .above = value + at.above,
                       .below = value + at.below,
                       .source = level->source[component] + (level->is_finest ? first : at.own),
                       .inverse = level->inverse + at.own};
}

static void relax_half(const Level *level, int odd, int y)
{
    for (int component = 0; component < 2; component++) {
        const FlColumns span = level->span[y];
        const FlStencil cells = stencil_at(level, component, odd, y, (size_t)span.first);
        fl_row_kernels()->relax(&cells, span.last - span.first);
    }
}

static void relax_red(const Level *level, const Level *other, int y)
{
    relax_half(level, y & 1, y);
}

static void relax_black(const Level *level, const Level *other, int y)
{
    relax_half(level, !(y & 1), y);
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
    const FlColumns span = fine->span[y];
    for (int odd = 0; odd < 2; odd++) {
        const size_t row = half_row(fine, odd, y) + (size_t)span.first;
        size_t parents[2][4];
        find_parents(coarse, odd, y, parents);
        for (int k = 0; k < 2; k++)
            fl_row_kernels()->refine(coarse->value[k] + span.first / 2, parents,
                                     fine->parents + row, fine->value[k] + row,
                                     (span.last - span.first) / 2);
    }
}

/** Makes a row of the coarse problem whose solution is the correction of the fine one. */
static void restrict_residual(const Level *coarse, const Level *fine, int y)
{
    const size_t even = half_row(coarse, 0, y), odd = half_row(coarse, 1, y);
    for (int k = 0; k < 2; k++) {
        float *source = coarse->source[k];
        memset(coarse->value[k] + even, 0, 2 * coarse->half * sizeof(float));
        memset(source + even, 0, 2 * coarse->half * sizeof(float));
        for (int child = 0; child < 4 && 2 * y + child / 2 < fine->height; child++) {
            const FlColumns span = fine->span[2 * y + child / 2];
            const size_t first = (size_t)span.first, half = first / 2;
            const FlStencil cells = stencil_at(fine, k, child & 1, 2 * y + child / 2, first);
            fl_row_kernels()->add_residual(&cells, source + even + half, source + odd + half,
                                           (span.last - span.first) / 2);
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
static void store_half(const Grid *grid, int component, int odd, int y, float *field)
{
    const Level *level = &grid->level[0];
    const size_t row = half_row(level, odd, y);
    const uint8_t *cell = level->cell + row;
    const float low = grid->low[component], high = grid->high[component];
    float *restrict value = level->value[component] + row;
    for (int i = level->span[y].first; i < level->span[y].last; i++) {
        const float clamped = MAX(low, MIN(high, value[i]));
        value[i] = cell[i] ? clamped : 0.0f;
    }
    for (int x = odd; x < level->width; x += 2)
        field[2 * x + component] = value[x / 2];
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
    for (int y = 0; y < height; y++)
        for (int k = 0; k < 4; k++)
            store_half(&grid, k / 2, k % 2, y, field + 2 * y * (size_t)width);
    return true;
}
