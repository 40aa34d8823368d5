/* The motion of the drawing itself, which its outline need not show: displacements and turns. */
#pragma once

#include "guides/guides.h"
#include "guides/outline.h"

/**
 * The fixed-point motion of the outline's box from that of the frame, in px. No displacement is
 * longer than the larger side of the frame. What is not a number is unknown; outside the mask the
 * motion is 0, so that it can be stored in little.
 */
void fl_motion_to_fixed(const float *motion, const FlOutline *outline, int32_t *fixed);

/** Makes the motion outside the mask unknown. */
void fl_motion_confine(FlGuides *guides);

/**
 * Fills guides->turn: the rotation that is nearest to the motion around each pixel. Differences are
 * taken where motion is known, and not across seams between parts that move apart.
 */
void fl_motion_turns(FlGuides *guides);
