/* Laplace's equation inside a shape, by multigrid: how values on the contour spread inward. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum FlSolverCell {
    FL_CELL_OUTSIDE,
    FL_CELL_FREE,  // to be solved
    FL_CELL_FIXED, // given
} FlSolverCell;

/**
 * Fills the free cells with the harmonic field of the fixed ones [F21 App. A, Johnston02]; no value
 * passes through outside cells or the frame, which insulate.
 *
 * cell: width * height FlSolverCell. field: interleaved pairs, 2 * width * height; read where
 * fixed, written everywhere (0 outside). Every component of the result lies between the least and
 * greatest fixed value. Free cells that no fixed one reaches also get values in that range; fix
 * them if their values matter.
 *
 * cycles: V-cycles after the first solution, which comes from the coarse levels: 0 where only
 * smoothness matters, 2 for an error of about 1 % of the range.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_laplace_solve(const uint8_t *cell, int width, int height, int cycles, float *field,
                      GError **error);
