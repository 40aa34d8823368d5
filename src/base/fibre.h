/* Fibres of paper: short curved lines. */
#ifndef FLUIDY_BASE_FIBRE_H
#define FLUIDY_BASE_FIBRE_H

#include "base/rng.h"

/** The shape of fibres. */
typedef struct FlFibre {
    float length_px; // mean
    float curl;      // rate of turning; 1: like paper fibres
    float scale;     // enlargement of a fibre, whose width is about a px at 1
} FlFibre;

/**
 * Draws a fibre from a place on: each pixel of the width * height grid gets 0..1 by how near the
 * middle of the fibre it is, where that is more than it has. The place may be beyond the grid.
 */
void fl_fibre_draw(float *grid, int width, int height, float x, float y, const FlFibre *fibre,
                   FlRng *rng);

#endif
