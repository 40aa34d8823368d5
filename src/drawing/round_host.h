/* The rotation of round shapes, measured on the leaves inside them. */
#ifndef FLUIDY_DRAWING_ROUND_HOST_H
#define FLUIDY_DRAWING_ROUND_HOST_H

#include "drawing/correspondence.h"
#include "drawing/pairing.h"

/** Gives round leaves that rest, move or grow the turn of two or more leaves of their group that
 * lie inside them in both frames, if these agree to half a pixel. */
void fl_turn_round_hosts(const FlTwoFrames *frames, const FlLeafMeasure *before,
                         const FlLeafMeasure *now, FlCorrespondence *correspondence);

#endif
