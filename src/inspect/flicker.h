/* How much paint changes from frame to frame, where it stays inside its region. */
#ifndef FLUIDY_INSPECT_FLICKER_H
#define FLUIDY_INSPECT_FLICKER_H

#include "compose/painted_region.h"

/** What a painter's last frame was like: rect.width * rect.height of the painter. */
typedef struct FlFlicker {
    uint8_t *luma, *mask; // NULL: no frame yet
    int16_t *motion;      // x, y: px to the next frame
    double change;        // of the last frame, see fl_flicker_measure()
} FlFlicker;

void fl_flicker_clear(FlFlicker *flicker);

/**
 * Compares the picture that the painter has just made with the one before, in the style's own
 * colours, each pixel with where the flow has carried it. guides are the new frame's.
 *
 * Sets flicker->change to the mean absolute difference of luma, in levels of 255, over the pixels
 * that lie in the region before and after; NAN if there are none. FL_ERROR_NO_MEMORY.
 */
bool fl_flicker_measure(FlFlicker *flicker, const FlPaintedRegion *painted, const FlGuides *guides,
                        GError **error);

/** The same of the exemplar itself, which is not moved: mean over its frames; NAN if it has one. */
double fl_flicker_of_exemplar(const FlExemplar *exemplar);

#endif
