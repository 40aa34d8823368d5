/* The energy of a field, term by term: for statistics, not for the search. */
#ifndef FLUIDY_SYNTH_ENERGY_H
#define FLUIDY_SYNTH_ENERGY_H

#include "synth/patchmatch.h"

/** Means per pixel in the paper's units: each term with its weight [F21 eq. 1]. */
typedef struct FlEnergy {
    double texture, bound, ext, direction, temporal; // the data terms
    double uniformity, coherence;
} FlEnergy;

/**
 * The energy of search->nnf with the target's colours and T_temp as they are.
 *
 * `target` is search->target; its colours are blended anew for each term and once more at the end.
 * costs: scratch, width * height. Takes about a fifth of a sweep's time.
 */
void fl_energy_of(const FlSearch *search, FlTargetLevel *target, uint32_t *costs, FlEnergy *energy);

#endif
