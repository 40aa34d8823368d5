/* The outlines of a drawing's frames, and which leaves make up a region. */
#pragma once

#include "drawing/drawing.h"
#include "svg/geometry.h"

/** A leaf of a region, or its part in that region. */
typedef struct FlRegionLeaf {
    int leaf; // index into the frame's outlines
    FlPart part;
    float box[4];   // x0, y0, x1, y1 of what librsvg draws of it, px
    uint8_t rgb[3]; // its paint, or the mean colour
    bool flat;
} FlRegionLeaf;

/** Reads a frame's outlines, in px of the picture. Any thread. NULL with an error that names it. */
FlOutlines *fl_drawing_outlines(const FlDrawing *drawing, int frame, GError **error);

/** The leaves of a region in a frame, bottom up; region < 0: of all. An array of FlRegionLeaf. */
GArray *fl_drawing_region_leaves(const FlDrawing *drawing, int frame, int region,
                                 const FlOutlines *outlines);

/** The region and the paint of a leaf, by its first part. */
typedef struct FlLeafFill {
    int region; // -1: it is not drawn
    int nth;    // of the region's leaves in the film: the same leaf has one number in all frames
    bool flat;
    uint8_t rgb[3];
} FlLeafFill;

/** The fills of a frame's leaves, by index; to be freed with g_free(). */
FlLeafFill *fl_drawing_leaf_fills(const FlDrawing *drawing, int frame, const FlOutlines *outlines);

/** True if both frames show one file. */
bool fl_drawing_same_file(const FlDrawing *drawing, int a, int b);
