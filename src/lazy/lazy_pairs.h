/* The guides of LazyFluids as pairs of pictures. */
#ifndef FLUIDY_LAZY_LAZY_PAIRS_H
#define FLUIDY_LAZY_LAZY_PAIRS_H

#include "lazy/fluid_planes.h"
#include "synth/guide_pairs.h"

/**
 * The pairs of a frame [L15 (9)]: blurred alpha, segments, and the past's colours and alpha, if
 * there is one, each with its weight; planes are those of level 0. The style is the exemplar's
 * frame with its alpha; multiplied: planes have colours times alpha, and the style straight ones.
 * paper: sRGB, of colours where there is no fluid.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set; pairs need clearing in any case.
 */
bool fl_lazy_pairs(const FlFluidPlanes *source, const FlFluidPlanes *target,
                   const FlFluidWeights *weights, const uint8_t paper[3], bool multiplied,
                   FlGuidePairs *pairs, GError **error);

#endif
