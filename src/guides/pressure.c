#include "guides/pressure.h"

#include "base/alloc.h"
#include <math.h>
#include <string.h>

#define PRECISION 1e-2 // of the residual, a share of the right side
#define MOST_STEPS 200
#define MODIFIED 0.97   // share of the fill-in that the factor adds to its diagonal
#define LEAST_PIVOT .25 // of the diagonal
#define GROUND 1e-6     // added to the diagonal: a part that is closed all around has no level

enum { LEFT, RIGHT, UP, DOWN, SIDES };

/** An unknown: a cell, and those beside it. */
typedef struct Row {
    int cell;
    int near[SIDES];   // unknowns; where there is none, one past the last, which stays 0
    float open[SIDES]; // of the faces to them
    double diagonal, factor;
} Row;

struct FlPressure {
    Row *row;
    int n;            // unknowns of the frame in hand
    int32_t *unknown; // by cell; -1: none
    double *x, *left, *better, *step,
        *push; // solution, residual, L'L-solved, direction, A direction
};

FlPressure *fl_pressure_new(size_t cells, GError **error)
{
    const size_t n = cells + 1;
    const char *what = "a fluid";
    g_autoptr(FlPressure) solver = g_new0(FlPressure, 1);
    if ((solver->row = fl_alloc(n, sizeof *solver->row, what, error)) &&
        (solver->unknown = fl_alloc(n, sizeof *solver->unknown, what, error)) &&
        (solver->x = fl_alloc(5 * n, sizeof *solver->x, what, error))) {
        solver->left = solver->x + n, solver->better = solver->left + n;
        solver->step = solver->better + n, solver->push = solver->step + n;
        return g_steal_pointer(&solver);
    }
    return NULL;
}

void fl_pressure_free(FlPressure *solver)
{
    if (!solver)
        return;
    free(solver->row);
    free(solver->unknown);
    free(solver->x);
    g_free(solver);
}

static void number_cells(FlPressure *solver, const FlCells *cells)
{
    solver->n = 0;
    for (int c = 0; c < cells->n; c++) {
        solver->unknown[c] = cells->solved[c] ? solver->n : -1;
        if (cells->solved[c])
            solver->row[solver->n++].cell = c;
    }
}

static void join_cells(FlPressure *solver, const FlCells *cells)
{
    for (int i = 0; i < solver->n; i++) {
        Row *row = &solver->row[i];
        const int c = row->cell, stride = cells->stride;
        const int beside[SIDES] = {c - 1, c + 1, c - stride, c + stride};
        const float open[SIDES] = {cells->across[c], cells->across[c + 1], cells->down[c],
                                   cells->down[c + stride]};
        row->diagonal = GROUND;
        for (int s = 0; s < SIDES; s++) {
            const int other = open[s] > 0 ? solver->unknown[beside[s]] : -1;
            row->near[s] = other >= 0 ? other : solver->n;
            row->open[s] = other >= 0 ? open[s] : 0;
            row->diagonal += (double)open[s];
        }
    }
}

/** The modified incomplete factor: the inverse of the diagonal of L. */
static void factorise(FlPressure *solver)
{
    Row *row = solver->row;
    row[solver->n] = (Row){.factor = 0};
    for (int i = 0; i < solver->n; i++) {
        const Row *left = &row[row[i].near[LEFT]], *up = &row[row[i].near[UP]];
        const double a = row[i].open[LEFT] * left->factor, b = row[i].open[UP] * up->factor;
        const double pivot = row[i].diagonal - a * a - b * b -
                             MODIFIED * (a * left->factor * (double)left->open[DOWN] +
                                         b * up->factor * (double)up->open[RIGHT]);
        row[i].factor = 1 / sqrt(pivot < LEAST_PIVOT * row[i].diagonal ? row[i].diagonal : pivot);
    }
}

/** better = (L L')^-1 left */
static void precondition(FlPressure *solver)
{
    const Row *row = solver->row;
    double *z = solver->better;
    for (int i = 0; i < solver->n; i++) {
        const int left = row[i].near[LEFT], up = row[i].near[UP];
        z[i] = (solver->left[i] + row[i].open[LEFT] * row[left].factor * z[left] +
                row[i].open[UP] * row[up].factor * z[up]) *
               row[i].factor;
    }
    for (int i = solver->n - 1; i >= 0; i--)
        z[i] = (z[i] + row[i].factor * (row[i].open[RIGHT] * z[row[i].near[RIGHT]] +
                                        row[i].open[DOWN] * z[row[i].near[DOWN]])) *
               row[i].factor;
}

static void multiply(const FlPressure *solver, const double *v, double *out)
{
    for (int i = 0; i < solver->n; i++) {
        const Row *row = &solver->row[i];
        double sum = row->diagonal * v[i];
        for (int s = 0; s < SIDES; s++)
            sum -= row->open[s] * v[row->near[s]];
        out[i] = sum;
    }
}

static double product(const double *a, const double *b, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/** Conjugate gradients from x; `left` holds the right side. */
static void descend(FlPressure *solver)
{
    const int n = solver->n;
    const double goal = PRECISION * PRECISION * (product(solver->left, solver->left, n) + 1e-12);
    multiply(solver, solver->x, solver->push);
    for (int i = 0; i < n; i++)
        solver->left[i] -= solver->push[i];
    precondition(solver);
    memcpy(solver->step, solver->better, (size_t)n * sizeof *solver->step);
    double good = product(solver->left, solver->better, n);
    for (int k = 0; k < MOST_STEPS && product(solver->left, solver->left, n) > goal; k++) {
        multiply(solver, solver->step, solver->push);
        const double length = good / product(solver->step, solver->push, n);
        for (int i = 0; i < n; i++) {
            solver->x[i] += length * solver->step[i];
            solver->left[i] -= length * solver->push[i];
        }
        precondition(solver);
        const double last = good;
        good = product(solver->left, solver->better, n);
        for (int i = 0; i < n; i++)
            solver->step[i] = solver->better[i] + good / last * solver->step[i];
    }
}

void fl_pressure_solve(FlPressure *solver, const FlCells *cells, const double *missing,
                       float *pressure)
{
    number_cells(solver, cells);
    join_cells(solver, cells);
    factorise(solver);
    const int n = solver->n;
    solver->x[n] = solver->better[n] = solver->step[n] = 0;
    for (int i = 0; i < n; i++) {
        solver->x[i] = (double)pressure[solver->row[i].cell];
        solver->left[i] = missing[solver->row[i].cell];
    }
    descend(solver);
    memset(pressure, 0, (size_t)cells->n * sizeof *pressure);
    for (int i = 0; i < n; i++)
        pressure[solver->row[i].cell] = (float)solver->x[i];
}
