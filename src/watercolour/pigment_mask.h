/* The mask of the paint, from the thickness of the pigment. */
#ifndef FLUIDY_WATERCOLOUR_PIGMENT_MASK_H
#define FLUIDY_WATERCOLOUR_PIGMENT_MASK_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** Lengths in cells. */
typedef struct FlExtract {
    float threshold; // of the blurred thickness
    int blur;        // radius of the blur, >= 0
    int speck, hole; // smaller specks of paint and smaller gaps are ignored, cells
    float margin;    // margin of the mask around the paint
} FlExtract;

/**
 * The signed distance of every cell's centre to the rim of the mask, positive inside, in cells.
 *
 * thickness has width * height values, >= 0, and is blurred in place; distance receives as many.
 * Without paint, all distances are about minus the size of the picture. FL_ERROR_NO_MEMORY.
 */
bool fl_extract_mask(float *thickness, int width, int height, const FlExtract *extract,
                     float *distance, GError **error);

#endif
