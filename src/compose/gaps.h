/* Edges a hair off: a sliver of paper between neighbours here, an overlap there. */
#pragma once

#include "compose/layers.h"
#include "drawing/drawing.h"

/** The displacement of a region's edges. */
typedef struct FlGaps {
    float strength;  // 0..1
    uint64_t key;    // of the film's seed and the region's name
    FlAnchor anchor; // of the region, along which the edges that are off move
    float scale;     // px of the frame per px of the page
} FlGaps;

/**
 * Moves the paint of a layer, before the stack is resolved, by up to 1.7 px of the page, slowly
 * from place to place. Where it goes beyond its own shape it does not knock out what lies below.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_layer_open_gaps(FlLayer *layer, const FlGaps *gaps, FlRect page, GError **error);
