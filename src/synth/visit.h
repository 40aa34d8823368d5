/* One pixel of the search: propagation and random search. */
#ifndef FLUIDY_SYNTH_VISIT_H
#define FLUIDY_SYNTH_VISIT_H

#include "synth/patchmatch.h"

#define FL_MAX_WINDOWS 64

/** What all visits of a search have in common. */
typedef struct FlVisitPlan {
    const FlSearch *search;
    int n_windows;
    struct {
        uint16_t x, y, frame; // how far a try may be from the match, pixels and frames
    } window[FL_MAX_WINDOWS];
    uint32_t coherence[5][5]; // [neighbours][of which continue elsewhere]
} FlVisitPlan;

void fl_visit_plan_init(FlVisitPlan *plan, const FlSearch *search);

/** Improves the match of a pixel of the target; `key` decides the random tries. */
void fl_visit_pixel(const FlVisitPlan *plan, int x, int y, uint64_t key, FlSearchCounts *counts);

#endif
