/* The use of each part of the exemplar: the uniformity term [F21 §3.5]. */
#pragma once

#include "synth/nnf.h"

/*
 * The paper's map Omega* counts the cuboids of n x n x (2r+1) pixels that cover each exemplar
 * pixel, and a patch sums the map over its own n x n pixels: together, matches are counted under a
 * tent about 2n wide and 4r long. We count matches in cells of 3 x 3 pixels and r+1 frames and
 * filter the counts with [1 2 1] along each axis, which is that tent to within a cell. Then a
 * changed match costs two additions instead of 25 (2r+1), so that the map can be refreshed sixteen
 * times per sweep: with a stale map, whole areas leave the same patch together.
 */
#define FL_CELL 3
#define FL_CELL_FACTOR 10923 // pixel p is in cell (2p + 1) * FL_CELL_FACTOR >> 16

#define FL_OCCURRENCE_MOST 536870912.0f // 2^29: what the term costs at most

/** A match that went from one cell to another; their indices. */
typedef struct FlCellMove {
    uint32_t from, to;
} FlCellMove;

typedef struct FlOccurrence {
    int columns, rows, slices;
    int first;                      // the exemplar's first frame that is searched
    uint16_t slice_factor;          // the t-th from there is in slice (2t + 1) * slice_factor >> 16
    int32_t *count[FL_SEGMENTS];    // matches per cell
    int32_t *filtered[FL_SEGMENTS]; // the same under the tent, by _refresh
    FlCellMove *moves[FL_SEGMENTS]; // since then: room for most_moves
    int n_moves[FL_SEGMENTS];       // more than most_moves: some are not listed
    int most_moves;
    float price[FL_SEGMENTS]; // cost of one filtered unit
} FlOccurrence;

/** An empty map for a level and a target; w_uni 0 makes every term 0. */
bool fl_occurrence_init(FlOccurrence *map, const FlExemplarLevel *level,
                        const FlTargetLevel *target, const FlParams *params,
                        const FlCostScale *scale, GError **error);
void fl_occurrence_clear(FlOccurrence *map);

/** Counts a whole field anew, and refreshes. */
void fl_occurrence_count(FlOccurrence *map, const FlNnf *nnf, const FlTargetLevel *target);

/** Moves one match. Threads may do so at the same time: additions have no order. */
void fl_occurrence_move(FlOccurrence *map, FlSegment segment, FlMatch from, FlMatch to);

/** Filters the counts again, or adds the tents of the moves if these are few. One thread. */
void fl_occurrence_refresh(FlOccurrence *map);

static inline uint16_t fl_occurrence_slice(const FlOccurrence *map, int frame)
{
    return (uint16_t)((uint32_t)(2 * (frame - map->first) + 1) * map->slice_factor >> 16);
}

/** A cell of the map. */
typedef struct FlCell {
    int x, y, t;
} FlCell;

static inline FlCell fl_occurrence_cell(const FlOccurrence *map, FlMatch m)
{
    return (FlCell){fl_match_x(m) / FL_CELL, fl_match_y(m) / FL_CELL,
                    fl_occurrence_slice(map, m.frame)};
}

static inline size_t fl_occurrence_index(const FlOccurrence *map, FlCell cell)
{
    return ((size_t)cell.t * map->rows + cell.y) * map->columns + cell.x;
}

/**
 * The term for a candidate in a cell, of a pixel whose match is in cell `own`: 1.0 of the paper's
 * energy where the use is what an even use of the segment would be. The pixel's own use does not
 * count.
 */
static inline uint32_t fl_occurrence_cost(const FlOccurrence *map, FlSegment segment, FlCell cell,
                                          FlCell own)
{
    const int dx = abs(cell.x - own.x), dy = abs(cell.y - own.y), dt = abs(cell.t - own.t);
    const int self = dx < 2 && dy < 2 && dt < 2 ? (2 - dx) * (2 - dy) * (2 - dt) : 0;
    const int use = map->filtered[segment][fl_occurrence_index(map, cell)] - self;
    return (uint32_t)MIN((float)MAX(use, 0) * map->price[segment], FL_OCCURRENCE_MOST);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlOccurrence, fl_occurrence_clear)
