/* A lower layer fades below the thin paint of an upper shape unless it goes on beyond that shape.
 */
#pragma once

#include "compose/layers.h"

/** The share of each pixel that the shapes above some layers leave free. */
typedef struct FlUnderlay {
    int width, height; // of the frame
    uint8_t *free;     // of each pixel, 0..255
} FlUnderlay;

bool fl_underlay_init(FlUnderlay *above, int width, int height, GError **error);
void fl_underlay_clear(FlUnderlay *above);

/**
 * Notes what lies over the next layer, for fl_fade_find(), and adds it to those above; the top one
 * comes first. Its area, its coverage and its stacking are enough; painted: it will get a knockout.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_underlay_next(FlUnderlay *above, FlLayer *layer, bool painted, GError **error);

/**
 * Finds how a noted layer fades below others that knock out: where their paint is thin, and the
 * nearest way out from under them does not lead to the layer. Else there would be dashes of a lower
 * colour along an outline that both share, and slivers of a pixel beside what lies above.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_fade_find(FlLayer *layer, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlUnderlay, fl_underlay_clear)
