/* Occlusion culling: the part of a layer that those above hide is not painted. */
#ifndef FLUIDY_COMPOSE_CULLING_H
#define FLUIDY_COMPOSE_CULLING_H

#include "compose/layers.h"

/**
 * Takes those pixels out of a layer's area and coverage that those above hide, before it is
 * painted: the frame stays, bit for bit. coverage becomes the layer's own, if any are. above: NULL:
 * the layer stays whole, as one that is stored must. FL_ERROR_NO_MEMORY.
 */
bool fl_layer_cull(FlLayer *layer, const FlLayersAbove *above, GError **error);

#endif
