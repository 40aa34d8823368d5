/* The leaves of two frames, paired. */
#ifndef FLUIDY_DRAWING_PAIRING_H
#define FLUIDY_DRAWING_PAIRING_H

#include "drawing/correspondence.h"

/** The measures by which leaves are compared. */
typedef struct FlLeafMeasure {
    double x0, y0, x1, y1; // box of its outline, px; empty: x1 < x0
    uint64_t structure;    // hash of its subpaths' lengths
} FlLeafMeasure;

/** By leaf; to be freed with g_free(). */
FlLeafMeasure *fl_measure_leaves(const FlOutlines *outlines);

double fl_measure_diagonal(const FlLeafMeasure *m);

/**
 * Pairs each leaf of now with a leaf before; -1: not paired. Where all agree by number, name, place
 * and structure they are paired one to one.
 *
 * Returns: by leaf; to be freed with g_free().
 */
int *fl_pair_leaves(const FlTwoFrames *frames, const FlLeafMeasure *before,
                    const FlLeafMeasure *now);

/** Gives round leaves that rest, move or grow the turn of two or more leaves of their group that
 * lie inside them in both frames, if these agree to half a pixel. */
void fl_turn_round_hosts(const FlTwoFrames *frames, const FlLeafMeasure *before,
                         const FlLeafMeasure *now, FlCorrespondence *correspondence);

#endif
