/* A retrieval: its input and result, the state between its passes, and the passes. */
#pragma once

#include "params/params.h"
#include "synth/fluid_texel.h"
#include "synth/nnf.h"

/** The rule for equal use of the exemplar's patches. */
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

/** The statistics of a retrieval. Use counts patches, or blocks with FL_UNIFORM_BLOCK. */
typedef struct FlRetrieved {
    int passes;
    uint64_t evaluations; // of distances
    double energy;        // sum over targets of their distance in the paper's units
    int least, most;      // use
    size_t n_most;        // number of cells used least + 1 times, if most == least + 1
} FlRetrieved;

#define FL_RETRIEVAL_TURNS 4
#define FL_RETRIEVAL_KEPT 4 // won targets of a source that are kept at most
#define FL_NO_TARGET (-1)
#define FL_NO_OFFER UINT64_MAX

/** Offsets in the order of a patch's rows, and steps to the four neighbours, in a turned source. */
typedef struct FlSourceTurn {
    int32_t offset[FL_PATCH_PIXELS]; // in pixels of the source picture
    int8_t step[4][2];               // in source pixels; of the target it is fl_retrieval_steps[]
} FlSourceTurn;

extern const int8_t fl_retrieval_steps[4][2];

/** A source that may still be used, and its row in the table. */
typedef struct FlSourceLeft {
    uint32_t source, row;
} FlSourceLeft;

/** Source patch s is place s / n_turns, turned by s % n_turns quarters. A target is its pixel. */
typedef struct FlRetrievalRun {
    const FlRetrieval *in;
    uint32_t n_turns, n_sources, n_targets;
    FlSourceTurn turn[FL_RETRIEVAL_TURNS];
    int32_t *place_at; // by pixel of the source; FL_NO_TARGET
    int32_t *target;   // [n_sources]: what it proposes to
    uint32_t *cost;    // of that
    int32_t *won;      // [n_sources][n_kept]: the last targets won, newest first; FL_NO_TARGET
    uint32_t n_kept;
    uint32_t *warm;                  // targets of the warm start, source by source,
    uint32_t *warm_first, *warm_end; // ranges of each source; the first target may be taken
    uint64_t *is_free;               // by target, a bit each
    uint32_t *open;                  // free targets in scan order, and a few that are no longer
    uint32_t n_open, n_free;
    uint64_t *offer;                // by target: the least cost << 32 | a hash of the source
    uint32_t *cell;                 // by source: its patch or block
    uint32_t *use;                  // by cell
    uint32_t n_cells, quota, extra; // K, and the cells that may still be used K + 1 times
    uint32_t *tile_places, *tile_first;
    int tile_columns, n_tiles;
    uint32_t *table;  // of the end, when few pairs are left: all costs, row by row; NULL until then
    uint32_t *column; // its targets
    uint32_t n_columns;
    FlSourceLeft *left; // its rows, in the order of the sources
    uint32_t n_left;
    uint64_t pass_key;
    bool backwards; // the order of the pass
    FlRetrieved *done;
} FlRetrievalRun;

/**
 * Makes the run of a retrieval that has sources and targets, before its first pass. nnf: the warm
 * start. `run` is to be cleared in any case. FL_ERROR_NO_MEMORY.
 */
bool fl_retrieval_run_init(FlRetrievalRun *run, const FlRetrieval *retrieval, const FlNnf *nnf,
                           FlRetrieved *done, GError **error);
void fl_retrieval_run_clear(FlRetrievalRun *run);

/** The pixel in the middle of a source patch. */
static inline uint32_t fl_retrieval_pixel(const FlRetrievalRun *run, uint32_t source)
{
    return run->in->sources[source / run->n_turns];
}

/** Returns: true if a source may be used once more. */
static inline bool fl_retrieval_is_eligible(const FlRetrievalRun *run, uint32_t source)
{
    const uint32_t use = run->use[run->cell[source]];
    return use < run->quota || (use == run->quota && run->extra > 0);
}

/* ---- PatchMatch from the exemplar [L15 §5], in propose.c ---- */

/** One sweep: fills `target` and `cost` of every source; FL_NO_TARGET: it may not be used. */
void fl_propose_all(FlRetrievalRun *run);

/** The texels of a source patch, turned, in the order of its rows. */
void fl_retrieval_gather(const FlRetrievalRun *run, uint32_t source, FlFluidTexel *patch);

/** The first texel of the patch around a pixel. */
const FlFluidTexel *fl_retrieval_patch(const FlFluidPicture *picture, uint32_t pixel);

/* ---- nearest neighbours without regard to use, in nearest.c ---- */

/** fl_retrieve() for FL_UNIFORM_OFF: the nearest source patch of each target, by PatchMatch. Only
 * evaluations and energy are filled in. */
bool fl_nearest(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRetrievalRun, fl_retrieval_run_clear)
