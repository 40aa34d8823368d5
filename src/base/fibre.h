/* Fibres of paper: short curved lines. */
#ifndef FLUIDY_BASE_FIBRE_H
#define FLUIDY_BASE_FIBRE_H

#include "base/rng.h"

/** How fibres look. */
typedef struct FlFibre {
    float length_px; // mean
    float curl;      // how fast they turn, 1: as paper's
    float scale;     // by which a fibre is enlarged, and so its width, which is about a px
} FlFibre;

/**
 * Draws a fibre from a place on: each pixel of the width * height grid gets 0..1 by how near the
 * middle of the fibre it is, where that is more than it has. The place may be beyond the grid.
 */
void fl_fibre_draw(float *grid, int width, int height, float x, float y, const FlFibre *fibre,
                   FlRng *rng);

#endif
