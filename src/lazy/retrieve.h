/* Reversed retrieval: every source patch is used equally often [L15 §4.1]. */
#ifndef FLUIDY_LAZY_RETRIEVE_H
#define FLUIDY_LAZY_RETRIEVE_H

#include "params/params.h"
#include "synth/fluid_texel.h"
#include "synth/nnf.h"

/** How equally the patches of the exemplar are used. */
typedef enum FlUniform {
    FL_UNIFORM_AUTO,  // patches, where there are not more of them than targets; else blocks
    FL_UNIFORM_PATCH, // each one K or K + 1 times (5)
    FL_UNIFORM_BLOCK, // the same of square blocks of patches, as many as there are targets at most
    FL_UNIFORM_OFF,   // as they fit: nearest neighbours, as in [L15 fig. 13]
} FlUniform;

/** One segment of one level. Places are row * width + column, in ascending order. */
typedef struct FlRetrieval {
    FlFluidPicture source, target;
    const uint32_t *sources, *targets; // the middles of their patches
    size_t n_sources, n_targets;
    bool turns; // each source patch in four orientations, which are patches of their own [L15 §4.5]
    FlUniform uniform;
    int sweeps;   // of PatchMatch in a pass, >= 1
    uint64_t key; // of the random numbers
    FlFluidDistance distance;
} FlRetrieval;

/** What a retrieval did. Use counts patches, or blocks where these are counted. */
typedef struct FlRetrieved {
    int passes;
    uint64_t evaluations; // of distances
    double energy;        // sum over targets of their distance in the paper's units
    int least, most;      // use
    size_t n_most;        // how many are used least + 1 times, where that is `most`
} FlRetrieved;

/**
 * Assigns a source patch to each target of the segment, (9) as small as can be found and uses as
 * `uniform` says: strictly, K = |T| / |S| rounded down or K + 1, these exactly |T| mod |S| times.
 *
 * Every pass lets each source patch with room left propose to the nearest free target that it
 * finds; a target takes the nearest of those that propose to it. nnf is as large as the target: the
 * matches of the segment's pixels are the warm start (none: FL_NO_MATCH) and are overwritten;
 * others stay. Matches have frame 0. The same bytes on any number of threads. Segments without
 * sources have no targets.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_retrieve(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error);

#endif
