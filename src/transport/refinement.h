/*
 * Adjusts the displacement of a region's ink to look more like the style: a potential that moves
 * with the drawing and is updated in every frame [Berlanga20, KAGS19].
 */
#ifndef FLUIDY_TRANSPORT_REFINEMENT_H
#define FLUIDY_TRANSPORT_REFINEMENT_H

#include "transport/region_plane.h"
#include "transport/sliced.h"
#include "transport/tile.h"

typedef struct FlRefinementInput {
    const FlSliced *patches; // of the style; borrowed
    const FlTransportStyle *style;
    float scale;    // px of the drawing per px of the style
    int iterations; // by frame; a first frame has ten times as many
    uint64_t seed;
} FlRefinementInput;

/** The state after a frame; all 0 before the first. */
typedef struct FlRefinement {
    FlRegionPlane plane;
    float *potential; // by pixel of the plane, px²: as it was solved
    float *shown;     // a mean of it along the motion
} FlRefinement;

/**
 * The next frame, whose region is not empty: adds to its ink's velocity, 2 by pixel of the layers'
 * rectangle, tapered px of the drawing. A region at rest is not refined further. Errors:
 * FL_ERROR_NO_MEMORY.
 */
bool fl_refinement_advance(FlRefinement *refinement, const FlRefinementInput *input,
                           const FlMaterialLayers *layers, const FlGuides *guides, float *velocity,
                           GError **error);

void fl_refinement_clear(FlRefinement *refinement);

/** Its bytes in a state: how many, and they themselves. */
size_t fl_refinement_bytes(const FlRefinement *refinement);
void fl_refinement_write(const FlRefinement *refinement, uint8_t *bytes);

/** Reads them; they need not be trusted: FL_ERROR_CHANGED. `most_px`: a side of the plane at most.
 */
bool fl_refinement_read(FlRefinement *refinement, const uint8_t *bytes, size_t size, int most_px,
                        GError **error);

#endif
