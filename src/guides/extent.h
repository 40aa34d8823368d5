/* Motion extents: how far the paint at a pixel has come, and how far it will go [F21 §3.3]. */
#pragma once

#include "guides/outline.h"

/** Flows and sums are in fixed point: exact, so that the order of additions does not matter. */
#define FL_FLOW_ONE 1024  // a flow or a sum of 1 px
#define FL_EXTENT_ONE 256 // an extent of 1 px

/** The nearest fixed-point flow; more than 1e5 px counts as 1e5. */
int32_t fl_flow_to_fixed(float px);

/** The running sum of one direction of time; starts at the first or the last frame. */
typedef struct FlExtent FlExtent;

FlExtent *fl_extent_new(int frame_width, int frame_height, GError **error);
void fl_extent_free(FlExtent *extent); // NULL is fine

/**
 * Advances the sum to the next frame: adds the flow of the interval between them inside the mask,
 * starts again at 0 outside, and writes the norm of the sum for the pixels of mask_box.
 *
 * coverage is of mask_box; flow is interleaved and of flow_box, NULL: no flow. Flow outside its box
 * is 0. A mask_box of no size empties the sum. extent: area of mask_box.
 */
void fl_extent_step(FlExtent *extent, const FlRect *mask_box, const uint8_t *coverage,
                    const FlRect *flow_box, const int32_t *flow, int32_t *norm);

/** True if a flow was ever added: until then the norm is 0 all over, and steps may be left out. */
bool fl_extent_moved(const FlExtent *extent);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlExtent, fl_extent_free)
