/* The potential whose gradient moves the ink: a sum of grids of 2, 4, 8 and 16 px [KAGS19].
 */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>

#define FL_POTENTIAL_GRIDS 4
#define FL_POTENTIAL_COARSEST (1 << FL_POTENTIAL_GRIDS) // px; divides the sides

/**
 * Grid l (0 …) has a node every 2^(l + 1) px, amid them. Finer grids would carry what central
 * differences do not see, coarser ones ink across the region. Everything is periodic.
 */
typedef struct FlPotential {
    int width, height; // px
    float *grid[FL_POTENTIAL_GRIDS];
} FlPotential;

/** All zero. Sides must be multiples of FL_POTENTIAL_COARSEST. FL_ERROR_NO_MEMORY. */
bool fl_potential_init(FlPotential *potential, int width, int height, GError **error);
void fl_potential_clear(FlPotential *potential);

size_t fl_potential_nodes(const FlPotential *potential, int grid);

/** The sum of all grids, enlarged by bicubic interpolation (a = -0.75): width * height, px². */
void fl_potential_sum(const FlPotential *potential, float *sum);

/** The adjoint: from the derivative by the sum, which it overwrites, that by each node. */
void fl_potential_adjoint(float *by_sum, FlPotential *by_node);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlPotential, fl_potential_clear)
