/* Mattes: the visible part of a shape below others. */
#pragma once

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>

/** A shape in a frame. */
typedef struct FlVisibleShape {
    const FlArea *area;
    const uint8_t *coverage; // of the area's box, 0..255; 0 beyond the area
} FlVisibleShape;

/**
 * The visible coverage of some columns of a row of a shape's box below others.
 *
 * above is a width * height plane, 0..255: the part of each pixel that what lies above the shape
 * takes. visible, one per pixel of the box's row, becomes the part of each of these columns in
 * which the shape is seen; visible + above <= 255 there.
 *
 * Two coverages alone do not tell where in the pixel the shapes lie. Where their edges run against
 * each other the shapes adjoin and share the pixel; where they run the same way the upper shape
 * hides the lower one's edge; where they cross, chance decides. The cosine between the two
 * gradients blends these three cases, so neighbours leave no paper between them and a shape exactly
 * covered leaves no fringe.
 */
void fl_visibility_row(const FlVisibleShape *shape, const uint8_t *above, int width, int height,
                       int row, FlColumns columns, uint8_t *visible);

/**
 * A shape grown by gap_px, 0 … FL_SPREAD_MAX_PX. matte is width * height and becomes 0..255, never
 * below coverage.
 */
void fl_visibility_spread(const FlVisibleShape *shape, int width, int height, float gap_px,
                          uint8_t *matte);

#define FL_SPREAD_MAX_PX 32
