/* Regions at rest: what has not moved, and is painted as it was. */
#ifndef FLUIDY_SYNTH_REST_H
#define FLUIDY_SYNTH_REST_H

#include "guides/guides.h"

/**
 * Fills in what a region at rest is known by, width * height: its mask, and inside it the depth,
 * which also depends on what moves beside it.
 */
void fl_rest_shape(const FlGuides *guides, uint8_t *shape);

/**
 * Whether a region rests: its shape is that of the last frame, which fl_rest_shape() filled in, and
 * no flow inside is faster than `still`, px a frame. A motion of the drawing that is known is no
 * rest, however slow it is, since it is seen after some frames.
 */
bool fl_rests(const FlGuides *guides, const uint8_t *last_shape, float still);

#endif
