/* The edges at which regions meet: a rim, or paint that goes on. */
#pragma once

#include "drawing/drawing.h"

/** An edge of a region's paint. As a region's limit: it and those before it are possible. */
typedef enum FlEdge {
    FL_EDGE_NONE,        // the region has no paint
    FL_EDGE_FREE,        // paint ends with a rim
    FL_EDGE_SAME_COLOUR, // paint goes on into a shape of its colour
    FL_EDGE_ADJACENT,    // paint goes on up to a shape beside the region, without a rim
} FlEdge;

/**
 * The edges of all pairs of regions of a film. They are decided for the film as a whole, since rims
 * that come and go between frames pop: by the length along which two regions meet in this way or
 * that, and by how opaque they are there.
 */
typedef struct FlNeighbours FlNeighbours;

FlNeighbours *fl_neighbours_new(int n_regions);
void fl_neighbours_free(FlNeighbours *neighbours); // NULL is fine

/**
 * Notes how the regions of a frame meet: shapes of nearly one fill, at most 8 apart by CIE76, those
 * with gradients by their means where they meet; and shapes side by side, where the lower one does
 * not go on below the upper one, or for a few pixels only. limits: by region. Any thread; a frame
 * once, before any of the film is asked about.
 */
void fl_neighbours_note(FlNeighbours *neighbours, const FlDrawList *draws, const FlEdge *limits);

/** The edge of a region where another one is; limits as noted. */
FlEdge fl_neighbours_edge(const FlNeighbours *neighbours, int region, int other,
                          const FlEdge *limits);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlNeighbours, fl_neighbours_free)
