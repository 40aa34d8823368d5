/* Two layers of material over a region: where one is strained, the other fades in, freshly laid. */
#pragma once

#include "transport/material.h"

/** All have the same rectangle. Without a share everything is the old layer. */
typedef struct FlMaterialLayers {
    FlMaterial old, fresh;
    FlMaterial share; // in place of shifts: visible share of each layer, 0..1; their sum is 1
} FlMaterialLayers;

/**
 * Carries the layers to the next frame and fades, by pixel and over some frames, from the old layer
 * to a fresh one where its pattern is stretched or squeezed; once the fresh one is strained as
 * well, the whole region follows, and it is the old one. Strain is a mean over `reach_px` around a
 * pixel, so that a tear between two limbs counts as little as it is wide. FL_ERROR_NO_MEMORY.
 */
bool fl_material_layers_advance(FlMaterialLayers *layers, const FlGuides *guides, FlRect rect,
                                int reach_px, GError **error);

/** The weights of the layers' velocities at pixel `p` of the rectangle: their squares sum to 1, so
 * that two patterns add up to one of the same contrast. */
void fl_material_layers_weights(const FlMaterialLayers *layers, size_t p, float *old, float *fresh);

void fl_material_layers_clear(FlMaterialLayers *layers);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlMaterialLayers, fl_material_layers_clear)
