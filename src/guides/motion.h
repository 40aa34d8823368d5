/* The motion of every pixel of a region, from the outlines of its leaves. */
#pragma once

#include "drawing/correspondence.h"
#include "guides/outline.h"

/** A region in two frames. All planes are of `rect`, row-major. */
typedef struct FlMovingRegion {
    FlRect rect;                           // in the frame
    int side;                              // the frame's larger side, px: the limit of motion
    const uint8_t *mask_before, *mask_now; // coverage 0..255
    FlOutlinePair outlines;                // of these masks, made where they are not known
    const FlOutlines *before, *now;
    const FlCorrespondence *motions; // of all leaves of `now`
    const GArray *leaves;            // FlRegionLeaf of `now`, bottom up
    const float *fluid; // the motion of a fluid in the region, as the motion; NULL: none
    float wetness;      // its share in the motion of leaves that are neither still nor affine, 0..1
} FlMovingRegion;

/** Pixel counts by the source of their motion, pixels with coverage >= FL_INSIDE. */
typedef struct FlMotionShares {
    int64_t exact;      // from outlines
    int64_t registered; // from masks
} FlMotionShares;

/**
 * Writes the motion of every pixel of the region: x - motion is its place in the frame before; px,
 * interleaved, 2 * area of rect, 0 outside.
 *
 * A leaf's outline is believed only if the contour of the region lies along it where librsvg draws
 * the leaf, or a clip or mask may have changed it; the others, and those whose structure changes,
 * have the motion of fl_registration(). Leaves that are new, grow, have jumped or may lie behind a
 * clip that opens have NAN: their paint spreads as the masks show. A fluid, where it is not NAN,
 * takes its share of what is known and all of what is not. shares may be NULL.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_motion_of_region(const FlMovingRegion *region, float *motion, FlMotionShares *shares,
                         GError **error);
