/* What lies below a shape is seen through its soft rim only where it is seen beyond it, too. */
#ifndef FLUIDY_COMPOSE_UNDERLAY_H
#define FLUIDY_COMPOSE_UNDERLAY_H

#include "compose/layers.h"

/**
 * Fades each painted layer out where others that knock out lie over it and the nearest way out from
 * under them does not lead to it: dashes of a lower colour along an outline that both share, and
 * slivers of a pixel beside what lies above. Elsewhere, rims of what lies above are as they were.
 *
 * layers are those that fl_layers_resolve() takes, and come before it; alpha of rgba and knockout
 * change. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_underlay_fade(FlLayer *layers, int n, int width, int height, GError **error);

/** The shapes above some layers, to do the same part by part. */
typedef struct FlUnderlay {
    int width, height; // of the frame
    uint8_t *coverage; // the greatest
    uint8_t *hides;    // 0..255, the greatest of those that are there
} FlUnderlay;

bool fl_underlay_init(FlUnderlay *above, int width, int height, GError **error);
void fl_underlay_clear(FlUnderlay *above);

/** The next n layers, which lie below those before. */
bool fl_underlay_fade_next(FlUnderlay *above, FlLayer *layers, int n, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlUnderlay, fl_underlay_clear)

#endif
