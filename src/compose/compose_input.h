/* The input of a composite frame. */
#pragma once

#include "compose/background.h"
#include "compose/contacts.h"
#include "compose/directions.h"
#include "compose/laid.h"
#include "compose/painted_region.h"
#include "compose/paper_sheet.h"
#include "drawing/drawing.h"

/** The stain that wet paint has left on the paper: a layer below all paint but that of the ground,
 * and one over each ground above other paint. */
typedef struct FlStainLayer {
    FlRect box;
    uint8_t *rgba;      // of the box, straight, over the paper; NULL: no stain
    const bool *ground; // by region: true if the stain lies over it
} FlStainLayer;

/** The painted regions of a frame and how they are stacked. Everything is borrowed. */
typedef struct FlComposeInput {
    const FlDrawing *drawing; // in the size in which it is painted
    const int *painted_of;    // by region: index into painted, FL_DRAWN_AS_IT_IS or FL_LEFT_OUT
    int n_painted;
    const FlPaintedRegion *const *painted;
    const FlBackground *background;
    const FlPaperSheet *sheet;  // of paper; NULL: no sheet
    FlTooth tooth;              // of the frame, in the size of the drawing
    FlDirections directions;    // of the hand
    uint64_t seed;              // of what is uneven
    int width, height;          // of the frame, px
    int number;                 // of the frame
    float paper_px;             // of the frame per px of the sheet of paper
    bool layers_apart;          // layers are stored as well, to be put on something else
    bool linear;                // blend in linear light
    float gap_px;               // as in FlStackParams
    const FlStainLayer *stain;  // NULL: none
    const FlContacts *contacts; // of regions that are wet together; NULL: there are none
    FlLaid *laid;               // takes the frame's paint as it is laid; NULL: not needed
} FlComposeInput;

/** The fill of a region through the film, or that which its gradient goes over into: the same in
 * all frames; borrowed. */
static inline const uint8_t *fl_fill_of_film(const FlComposeInput *input,
                                             const FlPaintedRegion *painted)
{
    const FlRegion *region = fl_drawing_region(input->drawing, painted->region);
    if (painted->settings->has_colour)
        return painted->settings->colour;
    return region->skin >= 0 ? fl_drawing_region(input->drawing, region->skin)->rgb : region->rgb;
}
