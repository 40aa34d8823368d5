/* Motion vectors of a frame, as compositors read them. */
#pragma once

#include "compose/composite.h"
#include "job/region_plan.h"
#include "render/motion_source.h"

/**
 * Sets composite->vectors: the motion of each pixel of the page since the frame before, px,
 * interleaved, to the right and down. It is that of the topmost region, and 0 where the picture is
 * held. halved: motion in half the size.
 *
 * Returns: false with an error as of fl_motion_source_get().
 */
bool fl_motion_vectors(const FlShapes *shapes, FlMotionSource *halved, int frame,
                       FlComposite *composite, GError **error);
