/* The cost of a match: the terms of the energy that a patch has by itself [F21 eq. 2]. */
#pragma once

#include "synth/occurrence.h"

/** The input and the field of a search on one level; all pointers are borrowed. */
typedef struct FlSearch {
    const FlExemplarLevel *level;
    const FlTargetLevel *target;
    const FlParams *params;
    const FlCostScale *scale;
    double w_coh; // of params, less for a smooth exemplar, which it would lay in visible pieces
    const FlKernels *kernels;
    FlNnf *nnf;           // in and out; every pixel of the target has a valid match
    uint32_t *cost;       // width * height: cost of the match without uniformity and coherence
    const FlNnf *carried; // the last field as the drawing has carried it here; NULL: it does not
    FlOccurrence *map;
    uint32_t settled;   // cheaper matches try only their neighbours' after a first look around
    int near_px;        // radius of that look; 0: no look
    int propagate_from; // sweeps from this one on try no random matches; 0: all sweeps do
    uint64_t key;       // of the random search
    // width * height, of the search: 1 + the last sweep in which a match changed, 0: never. Where
    // no neighbour has changed since a visit, the next does not try theirs again. NULL: it does.
    uint8_t *changed;
} FlSearch;

/** Counters of a search. */
typedef struct FlSearchCounts {
    uint64_t drawn;    // matches proposed; most are ruled out at once
    uint64_t tried;    // patch distances started
    uint64_t accepted; // matches that changed
} FlSearchCounts;

/**
 * Cost of a rotated exemplar patch against a gathered target patch: all but uniformity and
 * coherence, and age; once above limit, any number above limit.
 */
uint32_t fl_patch_cost(const FlSearch *search, const FlTargetPatch *patch, uint8_t target_angle,
                       const FlTexel *centre, uint8_t theta, uint32_t limit);

/** The term of what is fresher or drier in a frame of the exemplar than the pixel shall be. */
static inline uint32_t fl_age_cost(const FlSearch *search, size_t pixel, int frame)
{
    const FlTargetLevel *target = search->target;
    if (!target->fresh || search->params->w_age <= 0)
        return 0;
    const int apart = fl_freshness_of_frame(search->level, frame) - target->fresh[pixel];
    return (uint32_t)MIN(search->scale->age * (float)(apart * apart), 1 << 29);
}

/** Texture, guides, age and direction of a match: all but uniformity and coherence. */
uint32_t fl_match_cost(const FlSearch *search, int x, int y, FlMatch match);

/**
 * The extra cost of a match that does not continue the match carried to its pixel; 0 without a
 * carried match.
 *
 * Smooth patches fit anything a little, fine ones only their own like. Carried paint keeps its
 * frame of the exemplar, so what a search loses to smooth patches would not come back.
 */
uint32_t fl_leaving_cost(const FlSearch *search, size_t pixel);

/** True if two matches are in the same frame of the exemplar, within 3/4 px. */
static inline bool fl_match_same_place(FlMatch a, FlMatch b)
{
    return a.frame == b.frame && abs(a.x_16 - b.x_16) < FL_SAME_PLACE &&
           abs(a.y_16 - b.y_16) < FL_SAME_PLACE;
}

/** True if two matches show the same piece of the exemplar: same place, same rotation. */
static inline bool fl_match_continues(FlMatch a, FlMatch b)
{
    return fl_match_same_place(a, b) && fl_angle_distance((uint8_t)(a.theta - b.theta)) < 8;
}

#define FL_NEIGHBOURS 4

/** The matches that continue the left, upper, right and lower neighbours' at a pixel. Returns:
 * their number. */
int fl_matches_beside(const FlSearch *search, int x, int y, FlMatch expected[FL_NEIGHBOURS]);

/** The mean of search->cost over the pixels that have a match; 0 without any. */
double fl_mean_cost(const FlSearch *search);

/**
 * Fills search->cost; pixels outside get UINT32_MAX. Where the match of `previous` costs less, it
 * takes the place of the pixel's own [F21 §3.6]; NULL: there is no such field.
 */
void fl_search_costs(FlSearch *search, const FlNnf *previous);
