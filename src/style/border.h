/* Estimates the width of the paint's border, the zone of edge darkening and fringe. */
#ifndef FLUIDY_STYLE_BORDER_H
#define FLUIDY_STYLE_BORDER_H

#include "style/estimate.h"

/**
 * The border width b [F21 §3.1], in px: the depth below the outline from which on the mean colour
 * of all pixels of that depth keeps within a sixth of its whole change. From 3 px to a sixth of the
 * frame's shorter side; masks without any outline give the latter.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_border_estimate(const FlClip *clip, const uint8_t *mask, float *border_px, GError **error);

#endif
