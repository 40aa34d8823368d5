/* The pixels of a tile: propagation and random search. */
#pragma once

#include "synth/patch_cost.h"

/** Values shared by all pixels of a search. */
typedef struct FlTileSearch {
    const FlSearch *search;
    FlSearchWindows windows, near; // near: for matches that have settled
    uint32_t coherence[5][5];      // [neighbours][of which continue elsewhere]
} FlTileSearch;

void fl_tile_search_init(FlTileSearch *tile_search, const FlSearch *search);

#define FL_TILES_AT_ONCE 4

/**
 * Improves the matches of up to FL_TILES_AT_ONCE tiles, one pixel after the other, forwards in even
 * sweeps and backwards in odd ones.
 */
void fl_tile_search_run(const FlTileSearch *tile_search, const uint32_t *tiles, int n, int sweep,
                        FlSearchCounts *counts);
