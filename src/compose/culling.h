/* Occlusion culling: the part of a layer that those above hide is not painted. */
#ifndef FLUIDY_COMPOSE_CULLING_H
#define FLUIDY_COMPOSE_CULLING_H

#include "compose/layers.h"

/** What a layer is culled by. */
typedef struct FlCulling {
    const FlLayersAbove *above; // NULL: layers stay whole
    bool half;                  // the layer has half the size of the frame
} FlCulling;

/**
 * Takes those pixels out of a layer's area and coverage that those above hide, before it is painted
 * and enlarged: the frame stays, bit for bit. coverage becomes the layer's own, if any are. Not for
 * layers that are stored as well. FL_ERROR_NO_MEMORY.
 */
bool fl_layer_cull(FlLayer *layer, const FlCulling *culling, GError **error);

#endif
