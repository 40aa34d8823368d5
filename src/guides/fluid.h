/* The flow of a fluid inside a moving outline. */
#pragma once

#include "guides/outline.h"
#include "params/region_settings.h"

/** The behaviour of a fluid. */
typedef struct FlFluidDials {
    float memory;   // share of its velocity that it keeps from frame to frame, 0..1
    float emit;     // share of its growth that comes in where the contour rests, 0..1
    float buoyancy; // its rise along `up`, as a multiple of the speed of its contour
    float up[2];    // unit vector in the page
    float swirl;    // strength that is given back to whirls, 1: as much as the grid takes
    float drag;     // share by which the contour takes the fluid along, 0..1
    float stiff;    // share of the way to the motion of a rigid body, 0..1
    float burn;     // share of the contour that recedes without pushing the fluid back, 0..1
    float rise;     // flow through the shape, in at the foot and out at the top, 0..1
} FlFluidDials;

/** The dials of a region with a fluid: those of its kind, but for what the settings give. */
FlFluidDials fl_fluid_dials(const FlRegionSettings *settings);

/** A region's fluid through time; one thread at a time. */
typedef struct FlFluid FlFluid;

/**
 * A fluid in a region that stays within a part of a page, at rest. Its outlines are those of masks
 * of that part. Shapes are open where they touch the page's edge.
 *
 * Returns: NULL with FL_ERROR_NO_MEMORY set.
 */
FlFluid *fl_fluid_new(FlRect part, FlRect page, const FlFluidDials *dials, GError **error);
void fl_fluid_free(FlFluid *fluid); // NULL is fine

/** Starts a new sum of displacements: what fl_fluid_motion() gives is 0. */
void fl_fluid_begin(FlFluid *fluid);

/**
 * Moves the fluid by one frame and adds that to the displacement. The flow is incompressible; its
 * normal velocity at the contour is the contour's own, and what a shape gains in area comes in
 * where its contour rests, or everywhere. After an outline without a shape the fluid starts anew.
 * A frame with the outline of the frame before leaves the fluid where it is and takes a fifth of
 * its velocity and of its lift.
 */
void fl_fluid_step(FlFluid *fluid, const FlOutline *before, const FlOutline *now);

/** Writes the displacement of each pixel of the part, px, interleaved: x - motion is its place when
 * the sum was begun. NAN where there is no fluid: away from the shape and in new or leaping parts.
 */
void fl_fluid_motion(const FlFluid *fluid, float *motion);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlFluid, fl_fluid_free)
