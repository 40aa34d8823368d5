/* The last output carried along the motion: X^ and lambda_q [L15 §3.1, §4.3]. */
#pragma once

#include "guides/guides.h"
#include "lazy/fluid_planes.h"
#include "synth/nnf.h"

#define FL_FLUID_DEPTH 65535 // 1.0 of a stored output

/** The output from which the next frame is warped, RGBA like the exemplar's planes, with its mask
 * and field. All 0: empty. */
typedef struct FlFluidPast {
    uint16_t *rgba; // 0 … FL_FLUID_DEPTH
    uint8_t *mask;  // coverage
    FlNnf nnf;
} FlFluidPast;

/**
 * The motion into the frame, px, interleaved: the drawing's own where it is known, else the flow of
 * the masks. It is continued for `reach` px beyond the mask; NAN where motion is unknown: new fluid
 * appears at these pixels.
 */
bool fl_lazy_motion(const FlGuides *guides, int reach, float *motion, GError **error);

/**
 * Fills the planes of the past, and the weight of the past: 1, but 0 where the mask has fluid and
 * the warped mask is empty (6), per pixel. It also falls where the border of the past, as masks
 * blurred by sigma_px show it, has come into the interior: where fluid flows in, or shapes merge.
 * The planes have the blurred mask. Sampled by cubic splines at 1/16 px; `frame` decides which way
 * places are rounded, so that slow motions add up.
 */
bool fl_fluid_warp(const FlFluidPast *past, float sigma_px, const float *motion, int frame,
                   const FlKernels *kernels, FlFluidPlanes *planes, GError **error);

/**
 * The field carried along, to the nearest pixel. Where the past counts by less than half, or its
 * motion is unknown, the matches around are continued as far as the source has fluid there, so that
 * what flows in goes on with the texture that flows away; else FL_NO_MATCH. Frames are 0. The
 * planes have the blurred mask and the weight.
 */
bool fl_fluid_carry(const FlNnf *past, const float *motion, const FlFluidPlanes *planes,
                    const FlFluidPicture *source, FlNnf *now, GError **error);
