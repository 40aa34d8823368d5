/* Motion from two masks alone: the affine map that lays one outline over the other. */
#pragma once

#include "guides/outline.h"

/**
 * The motion into `now` of all its pixels, interleaved, px; 0 where coverage is 0.
 *
 * Each connected part that overlaps its past is moved as a whole (translation, rotation and, held
 * back, scale and shears) so that its contour lies where the distance to the contour before is
 * least; what is left of the normal motion is diffused inward. Motion that an outline does not
 * show, such as the turning of a disc, stays 0. A part for which that fails has the flow of
 * fl_flow_construct(). One without overlap is laid over the part that it may have jumped from
 * (part_tracking.h). Its motion is unknown, NAN, if there is no such part, if their contours differ
 * or if it is too small to tell.
 *
 * Both outlines are of frames of the same size, that of `motion`. Returns: false with
 * FL_ERROR_NO_MEMORY set.
 */
bool fl_registration(FlOutline *before, FlOutline *now, float *motion, GError **error);
