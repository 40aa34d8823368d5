/* The measures by which the leaves of two frames are compared. */
#ifndef FLUIDY_DRAWING_LEAF_MEASURE_H
#define FLUIDY_DRAWING_LEAF_MEASURE_H

#include "drawing/correspondence.h"

typedef struct FlLeafMeasure {
    double x0, y0, x1, y1; // box of its outline, px; empty: x1 < x0
    uint64_t structure;    // hash of its subpaths' lengths
} FlLeafMeasure;

/** By leaf; to be freed with g_free(). */
FlLeafMeasure *fl_measure_leaves(const FlOutlines *outlines);

double fl_measure_diagonal(const FlLeafMeasure *m);

/** Gives round leaves that rest, move or grow the turn of two or more leaves of their group that
 * lie inside them in both frames, if these agree to half a pixel. */
void fl_turn_round_hosts(const FlTwoFrames *frames, const FlLeafMeasure *before,
                         const FlLeafMeasure *now, FlCorrespondence *correspondence);

#endif
