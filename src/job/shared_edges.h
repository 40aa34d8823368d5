/* Regions between which paint goes on: the edge that they share gets no rim. */
#ifndef FLUIDY_JOB_SHARED_EDGES_H
#define FLUIDY_JOB_SHARED_EDGES_H

#include "drawing/drawing.h"

/**
 * Which regions share edges, in all frames of a film. It is decided for the film as a whole, since
 * rims that come and go between frames pop: regions whose colours drift apart, or that overlap now
 * and then, are taken as they are in most of the frames in which they meet.
 */
typedef struct FlSharedEdges FlSharedEdges;

/** Where a region's paint goes on. */
typedef enum FlJoin {
    FL_JOIN_UNPAINTED, // it has none
    FL_JOIN_ALONE,     // it ends at its contour
    FL_JOIN_ALIKE,     // into shapes of its colour
    FL_JOIN_CLOSED,    // and up to those that it borders on without overlapping them
} FlJoin;

FlSharedEdges *fl_shared_edges_new(int n_regions);
void fl_shared_edges_free(FlSharedEdges *edges); // NULL is fine

/**
 * Notes how the regions of a frame meet: opaque shapes of nearly one fill, at most 8 apart by
 * CIE76, those with gradients by their means where they meet; and shapes side by side, which
 * overlap by a few pixels at most. joins: by region. Any thread; a frame once, before any of the
 * film is asked about.
 */
void fl_shared_edges_note(FlSharedEdges *edges, const FlDrawList *draws, const FlJoin *joins);

/** How two regions share edges. */
typedef enum FlSharing {
    FL_SHARING_NONE,
    FL_SHARING_BESIDE, // they border on each other: paint goes on up to the edge
    FL_SHARING_ALIKE,  // and they are of one colour: there is no edge
} FlSharing;

/** Whether and how paint of `region` goes on where `other` is; joins as noted. */
FlSharing fl_shared_edges_get(const FlSharedEdges *edges, int region, int other,
                              const FlJoin *joins);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSharedEdges, fl_shared_edges_free)

#endif
