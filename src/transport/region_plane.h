/* The plane in which a region lies as on its material, in px of its style: it is turned and moved
 * with the region. */
#ifndef FLUIDY_TRANSPORT_REGION_PLANE_H
#define FLUIDY_TRANSPORT_REGION_PLANE_H

#include "transport/material_layers.h"

#define FL_REGION_PLANE_GRID 16 // px; divides the corners and sides

typedef struct FlRegionPlane {
    FlRigid lies; // the region on its material, px of the drawing
    float scale;  // px of the drawing per px of the plane
    FlRect box;   // around the region with some room: the plane's pixels
} FlRegionPlane;

/** The plane of a frame, with so much room around the region, px of the plane. The region is not
 * empty. */
FlRegionPlane fl_region_plane(const FlMaterialLayers *layers, const FlGuides *guides, float scale,
                              int room);

/** Returns: true if two planes are the same pixels of the frame. */
bool fl_region_plane_same(const FlRegionPlane *a, const FlRegionPlane *b);

/** The place in the frame of a pixel of the box. */
void fl_region_plane_to_frame(const FlRegionPlane *plane, int x, int y, float at[2]);

/** The place in the box of one in the frame. */
void fl_region_plane_from_frame(const FlRegionPlane *plane, float x, float y, float at[2]);

/** The depth in the region of a place in the frame, px of the plane; outside the rectangle of its
 * layers far beyond the contour. */
float fl_region_plane_depth(const FlRegionPlane *plane, const FlGuides *guides, FlRect rect,
                            float x, float y);

/** A velocity in px of the frame, turned to px of the plane. */
void fl_region_plane_turn(const FlRegionPlane *plane, const float frame[2], float of_plane[2]);

/** From velocities by pixel of the box, px of the plane, those by pixel of `rect`, px of the frame.
 */
void fl_region_plane_velocity(const FlRegionPlane *plane, const float *from, FlRect rect,
                              float *velocity);

/** The four pixels around a place, held to a plane of width * height, and their shares. */
typedef struct FlFour {
    size_t p[4];
    float share[4];
} FlFour;

FlFour fl_four_around(float x, float y, int width, int height);

/** Of values that lie `step` apart. */
float fl_mean_of_four(const float *plane, size_t step, const FlFour *four);

#endif
