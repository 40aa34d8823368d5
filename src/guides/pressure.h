/* The pressure that makes a flow on a grid of cut cells incompressible. */
#pragma once

#include <fluidy/error.h>
#include <stddef.h>
#include <stdint.h>

/** Scratch of the solver. */
typedef struct FlPressure FlPressure;

/** A grid of n cells, in rows of `stride`, and the openings of its faces, 0..1: `across` of the
 * left face of each cell, `down` of the upper one. */
typedef struct FlCells {
    int stride, n;
    const float *across, *down;
    const uint8_t *solved; // nonzero: the cell has a pressure; never on the border of the grid
} FlCells;

FlPressure *fl_pressure_new(size_t cells, GError **error);
void fl_pressure_free(FlPressure *solver); // NULL is fine

/**
 * Finds the pressure p of each solved cell: over its four faces, the sum of opening * (p - p there)
 * is the outflow that the cell misses. Other cells have pressure 0.
 *
 * Conjugate gradients with an incomplete Cholesky factor, from the given pressures to a residual of
 * 1 % of the norm; in scan order by one thread, so that the result is the same everywhere. pressure
 * and missing: of all cells.
 */
void fl_pressure_solve(FlPressure *solver, const FlCells *cells, const double *missing,
                       float *pressure);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPressure, fl_pressure_free)
