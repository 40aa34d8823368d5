/* Finds the potential that moves ink, which lies evenly, so that it makes a picture. */
#pragma once

#include "transport/flow_map.h"
#include "transport/potential.h"
#include <fluidy/style.h>

/** The problem to be solved, on a torus. */
typedef struct FlTransportProblem {
    int width, height;    // px, multiples of FL_POTENTIAL_COARSEST
    const float *picture; // densities, width * height of mean 1
    float pace; // factor on the steps: 1 draws clean bands, 3 reaches the wide features of a wash
} FlTransportProblem;

/**
 * Solves from a zero potential, coarse grids first; `effort` scales the number of
 * iterations (1: 260). progress may be NULL.
 *
 * potential: made by the caller in the problem's size. Returns: false with FL_ERROR_NO_MEMORY or
 * FL_ERROR_INTERRUPTED set.
 */
bool fl_transport_solve(const FlTransportProblem *problem, float effort, FlPotential *potential,
                        FlTransportProgress progress, void *data, GError **error);
