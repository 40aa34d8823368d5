/* The pixels of a tile: propagation and random search. */
#ifndef FLUIDY_SYNTH_VISIT_H
#define FLUIDY_SYNTH_VISIT_H

#include "synth/patchmatch.h"

/** What all visits of a search have in common. */
typedef struct FlVisitPlan {
    const FlSearch *search;
    FlWindows windows;
    uint32_t coherence[5][5]; // [neighbours][of which continue elsewhere]
} FlVisitPlan;

void fl_visit_plan_init(FlVisitPlan *plan, const FlSearch *search);

#define FL_TILES_AT_ONCE 4

/**
 * Improves the matches of up to FL_TILES_AT_ONCE tiles, one pixel after the other, forwards or
 * backwards; `key` decides the random tries.
 */
void fl_visit_tiles(const FlVisitPlan *plan, const uint32_t *tiles, int n, bool backwards,
                    uint64_t key, FlSearchCounts *counts);

#endif
