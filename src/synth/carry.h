/* The last field is carried along the drawing's motion: its matches, never its colours. */
#ifndef FLUIDY_SYNTH_CARRY_H
#define FLUIDY_SYNTH_CARRY_H

#include "synth/nnf.h"

/** How a field gets into the next frame. */
typedef struct FlCarry {
    const FlGuides *guides; // of the frame; the motion is theirs
    float carry; // how much of what spreading paint could show is carried as well, 0 … 1
    bool rotate; // matches may turn
    int frame;   // the frame-th painted one: decides which way places are rounded
} FlCarry;

/**
 * The matches of `before`, which lies at `from` in its frame, for the pixels of rect. The motion
 * falls into two parts: along the direction guide, which the exemplar's own time can show, and
 * across it, which it cannot. The latter is carried whole, the former by the share `carry`, less
 * where a shape grows, for paint that gets more room must spread. A pixel takes the match whose
 * paint comes nearest to it: FlMatch.off says where that is to a fraction of a pixel, so that
 * pieces of the exemplar travel as fast as what they show. The match moves by what its pixel was
 * off the one it was taken from, and turns.
 *
 * speed: px that are left for the exemplar's time to show, one per pixel of rect. Where no motion
 * is known nothing is carried, and the speed is that of the flow. A pixel without a match in the
 * frame before, or outside the mask, may have none and has no speed. `out` is as large as rect.
 */
void fl_nnf_carry(const FlNnf *before, FlRect from, const FlCarry *input, FlRect rect,
                  const FlExemplarLevel *level, FlNnf *out, float *speed);

#endif
