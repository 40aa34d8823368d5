/* What a network does with a region: how its ink moves, by the region's shape and its material. */
#ifndef FLUIDY_TRANSPORT_NETWORK_VELOCITY_H
#define FLUIDY_TRANSPORT_NETWORK_VELOCITY_H

#include "transport/material_layers.h"
#include "transport/network.h"

/** Where a region lies on its material, as its tile does. */
typedef struct FlNetworkPlace {
    float scale;     // px of the drawing per px of the network
    float origin[2]; // px of the drawing
    uint64_t seed;   // of the noise
} FlNetworkPlace;

/**
 * How the ink of a frame moves in the layers' rectangle, untapered px of the drawing: 2 by pixel.
 * The noise that breaks the symmetry of a flat fill lies on the material, and the network sees the
 * region as that lies, so that bands turn with the drawing. The region is not empty.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_network_velocity(const FlNetwork *network, const FlNetworkPlace *place,
                         const FlMaterialLayers *layers, const FlGuides *guides, float *velocity,
                         GError **error);

#endif
