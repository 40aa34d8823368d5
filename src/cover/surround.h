/* The surroundings of a region: shapes into which its paint goes on, and others. */
#pragma once

#include "cover/mask_store.h"
#include "cover/neighbours.h"
#include "drawing/drawing.h"

/** The shapes of every frame of a film: the regions' masks, and what is around them. */
typedef struct FlSurround FlSurround;

FlSurround *fl_surround_new(int n_regions, int n_frames, int width, int height, GError **error);
void fl_surround_free(FlSurround *surround); // NULL is fine

/** The masks of the regions. Returns: borrowed. */
FlMaskStore *fl_surround_masks(const FlSurround *surround);

/**
 * Notes the regions of a frame and what it shows around them; limits: by region, neighbours: of the
 * whole film; NULL: no region shares any. Only those that are painted, where painted_of is 0 or
 * more; NULL: all whose limit is an edge. ground, by region, is true of those on which the figures
 * move; NULL: all are figures. Any thread; a frame once.
 */
bool fl_surround_put(FlSurround *surround, int frame, const FlDrawList *draws, const FlEdge *limits,
                     const int *painted_of, const bool *ground, const FlNeighbours *neighbours,
                     GError **error);

/** Reads the lowest of the figures that have paint, at each pixel of a part of a frame: its region
 * + 1; 0: there is none. */
bool fl_surround_lowest(const FlSurround *surround, int frame, FlRect part, uint16_t *lowest,
                        GError **error);

/** The surroundings of a region, planes of a part of a frame. */
typedef struct FlSurroundPlanes {
    float joined;      // presence of shapes of its colour, 0: absent .. 1: opaque;
                       // see fl_neighbours_edge()
    float bordered;    // the same for the shapes that border on the region
    bool hidden;       // true if a shape lies over it and those of its colour
    uint8_t *together; // the region and those of its colour, near to where they are seen
    uint8_t *closed; // `together` and the bordering shapes, hidden or not; set if such shapes exist
    uint8_t *seen;   // the visible part of `together`; set if `hidden`
    uint8_t *shown;  // the coverage of all shapes
} FlSurroundPlanes;

/** Returns: true if the shapes that share edges with a region are the same near it in two frames,
 * whatever other shapes move there. */
bool fl_surround_joins_as_in(const FlSurround *surround, int region, int a, int b);

/** Reads a part of a frame. Returns: true with `around` to be cleared. */
bool fl_surround_get(const FlSurround *surround, int region, int frame, FlRect part,
                     FlSurroundPlanes *around, GError **error);

void fl_surround_planes_clear(FlSurroundPlanes *around);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlSurroundPlanes, fl_surround_planes_clear)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSurround, fl_surround_free)
