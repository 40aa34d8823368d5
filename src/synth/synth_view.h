/* The synthesis of a frame, for inspection: statistics and fields. */
#pragma once

#include "synth/patchmatch.h"

/** Statistics of one level; energies are means per pixel in the paper's units. */
typedef struct FlLevelStats {
    int width, height, pixels;
    int rounds;
    double energy_start, energy; // data terms of the field at the start and at the end
    // The terms at the end. The sum of the data terms exceeds the energy by the
    // difference of the two colours that the search blends: the last vote and T_temp.
    // The sum of the three terms of LazyFluids, texture, bound and temporal, is the energy.
    double texture, bound, ext, direction, temporal, uniformity, coherence;
    FlSearchCounts counts;
    double seconds;
} FlLevelStats;

typedef struct FlFrameStats {
    int n_levels;
    FlLevelStats level[FL_MAX_LEVELS];
    double seconds_target, seconds_temporal, seconds_search, seconds_vote;
} FlFrameStats;

/** The synthesis of a frame, for inspection: valid until the next frame. All of level 0 and `rect`
 * in px of the guides; matches point into the exemplar's own frames. */
typedef struct FlSynthView {
    FlRect rect;
    const FlNnf *nnf;
    const float *temporal, *temporal_weight; // T_temp and m; NULL in a first frame
} FlSynthView;

/** The synthesis of one region: it keeps the state of the last frame. */
typedef struct FlSynth FlSynth;
