/* The flow of a mask sequence from the motion of its contour [F21 App. A]. */
#pragma once

#include "guides/outline.h"

/** One frame with the distance field of its motion: the outline's, or a smoothed one. */
typedef struct FlFlowFrame {
    const FlOutline *outline; // NULL or empty: the shape is absent
    const float *distance;    // of the frame; unused if the shape is absent
} FlFlowFrame;

/**
 * Flow of one frame, from the interval before it. A part of the shape that is not in the frame
 * before takes the interval after it, as the whole first frame does; one that is in neither stays
 * at rest. One that moved by more than its own size has the velocity of its centre.
 *
 * Where the frame's contour and the other frame's nearest one face opposite ways, the difference of
 * distances does not measure normal motion (a thin part has moved by more than its width): these
 * pixels are left to the diffusion. limit_px bounds the speed. flow is interleaved, 2 * area of the
 * frame's box. now is not empty; all outlines share one frame size.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set; *moves tells if any flow is not 0.
 */
bool fl_flow_construct(const FlFlowFrame *now, const FlFlowFrame *before, const FlFlowFrame *after,
                       float limit_px, float *flow, bool *moves, GError **error);

/** Makes outline->normal: outward unit normals on the contour, diffused inward, not normalised. */
bool fl_outline_normals(FlOutline *outline, GError **error);
