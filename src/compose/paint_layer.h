/* One layer of a frame, in the size of the film: the paint of a region, or a plain fill. */
#pragma once

#include "compose/compose_input.h"
#include "compose/layers.h"
#include "compose/wash.h"
#include "cover/cover_map.h"

/** The sources of a frame's layers; borrowed. */
typedef struct FlLayerSources {
    const FlComposeInput *input;
    const FlCover *cover;   // of the frame
    const int *exposures;   // of each painted region
    const FlWashes *washes; // of the frame
} FlLayerSources;

/** The stacking of a region. Cut out paint hides by its own alpha alone, and does not knock out. */
FlStacking fl_stacking_of(const FlPaintedRegion *painted);

/** The layer of a draw, before it is painted: where it is, and how it lies over others. It borrows
 * from the draw. */
void fl_layer_begin(FlLayer *layer, const FlLayerSources *sources, int draw);

/** Paints the layer: rgba and knockout in the form that fl_layers_resolve() takes.
 * FL_ERROR_NO_MEMORY. */
bool fl_layer_paint(FlLayer *layer, const FlLayerSources *sources, int draw, GError **error);

/** Frees all that a layer owns. */
void fl_layer_clear(FlLayer *layer);
