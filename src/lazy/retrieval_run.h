/* A retrieval on its way: what its passes read and change. */
#ifndef FLUIDY_LAZY_RETRIEVAL_RUN_H
#define FLUIDY_LAZY_RETRIEVAL_RUN_H

#include "lazy/cost_table.h"
#include "lazy/retrieve.h"

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
    uint32_t *warm_first, *warm_end; // where those of a source stand; the first may be taken
    uint64_t *is_free;               // by target, a bit each
    uint32_t *open;                  // free targets in scan order, and a few that are no longer
    uint32_t n_open, n_free;
    uint64_t *offer;                // by target: the least cost << 32 | a hash of the source
    uint32_t *cell;                 // by source: what it counts for
    uint32_t *use;                  // by cell
    uint32_t n_cells, quota, extra; // K, and the cells that may still be used K + 1 times
    uint32_t *tile_places, *tile_first;
    int tile_columns, n_tiles;
    FlCostTable table;  // of the end, when few pairs are left; its costs are NULL until then
    FlSourceLeft *left; // then: in the order of the sources
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

/** Whether a source may be used once more. */
static inline bool fl_retrieval_is_eligible(const FlRetrievalRun *run, uint32_t source)
{
    const uint32_t use = run->use[run->cell[source]];
    return use < run->quota || (use == run->quota && run->extra > 0);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRetrievalRun, fl_retrieval_run_clear)

#endif
