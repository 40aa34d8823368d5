/* Finds the potential that moves a density so that its patches look like a style's. */
#ifndef FLUIDY_TRANSPORT_SOLVE_H
#define FLUIDY_TRANSPORT_SOLVE_H

#include "transport/flow_map.h"
#include "transport/potential.h"
#include "transport/sliced.h"
#include <fluidy/style.h>

/** The problem to be solved, on a torus. */
typedef struct FlTransportProblem {
    int width, height; // px, multiples of FL_POTENTIAL_COARSEST
    const FlSliced *style;
    const float
        *picture; // ink is to look like this, width * height of mean 1; NULL: like the style
    const float *density;  // before the transport, mean 1; NULL: 1 everywhere
    const float *coverage; // weight of its patches, 0 … 1; NULL: 1
    const float *taper;    // share of the velocity by pixel; NULL: 1
    const float *velocity; // an additional velocity, tapered, 2 by pixel; may be NULL
    const float *before;   // an additional potential; may be NULL
    FlTransportMode mode;
    float pace; // factor on the steps: 1 draws clean bands, 3 reaches the wide features of a wash
    uint64_t key;
} FlTransportProblem;

/**
 * Solves from a zero potential, coarse grids and levels first; `effort` scales the number of
 * iterations (1: some 230). progress may be NULL.
 *
 * potential: made by the caller in the problem's size. Returns: false with FL_ERROR_NO_MEMORY or
 * FL_ERROR_INTERRUPTED set.
 */
bool fl_transport_solve(const FlTransportProblem *problem, float effort, FlPotential *potential,
                        FlTransportProgress progress, void *data, GError **error);

/**
 * Brings what is there already nearer to the style, all grids and the finer levels at once: the
 * potential, made by the caller and 0, is what is to be added. FL_ERROR_NO_MEMORY.
 */
bool fl_transport_refine(const FlTransportProblem *problem, int iterations, FlPotential *potential,
                         GError **error);

#endif
