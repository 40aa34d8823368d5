/* Layers of drafts, which are made at half the size, in that of the frames. */
#ifndef FLUIDY_COMPOSE_ENLARGE_H
#define FLUIDY_COMPOSE_ENLARGE_H

#include "compose/layers.h"

/**
 * Makes a layer of a frame of width * height from one of fl_half_side() of both, bilinearly, as it
 * is before fl_layers_resolve(). Paint ends where coverage does: colours, opacity and knockout are
 * means of the pixels that are covered at all, so that edges that two shapes share stay whole.
 *
 * full: its coverage, rgba and knockout (NULL if half has none) are to be freed with free(), its
 * area with fl_area_clear(), also after FL_ERROR_NO_MEMORY.
 */
bool fl_layer_double(const FlLayer *half, int width, int height, FlLayer *full, GError **error);

#endif
