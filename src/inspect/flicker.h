/* The change of paint from frame to frame, where it stays inside its region. */
#ifndef FLUIDY_INSPECT_FLICKER_H
#define FLUIDY_INSPECT_FLICKER_H

#include "compose/painted_region.h"

/** The last frame of a region, in the size of its rect. */
typedef struct FlFlicker {
    uint8_t *luma, *mask; // NULL: no frame yet
    int16_t *motion;      // x, y: px to the next frame
    double change;        // of the last frame, see fl_flicker_measure()
} FlFlicker;

void fl_flicker_clear(FlFlicker *flicker);

/**
 * Compares the picture just painted with the one before, in the style's colours, along the flow.
 * guides are the new frame's.
 *
 * Sets flicker->change to the mean absolute difference of luma, in levels of 255, over the pixels
 * that lie in the region before and after; NAN without such pixels. Errors: FL_ERROR_NO_MEMORY.
 */
bool fl_flicker_measure(FlFlicker *flicker, const FlPaintedRegion *painted, const FlGuides *guides,
                        GError **error);

/** The same of the exemplar, without motion: mean over its frames; NAN if it has only one. */
double fl_flicker_of_exemplar(const FlExemplar *exemplar);

#endif
