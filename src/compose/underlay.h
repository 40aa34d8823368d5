/* What lies below a shape is seen through its soft rim only where it is seen beyond it, too. */
#ifndef FLUIDY_COMPOSE_UNDERLAY_H
#define FLUIDY_COMPOSE_UNDERLAY_H

#include "compose/layers.h"

/** The shapes above some layers. */
typedef struct FlUnderlay {
    int width, height; // of the frame
    bool half; // layers will be doubled before they are looked at: lengths are those of then
    uint8_t *coverage; // the greatest
    uint8_t *hides;    // 0..255, the greatest of those that are there
} FlUnderlay;

bool fl_underlay_init(FlUnderlay *above, int width, int height, bool half, GError **error);
void fl_underlay_clear(FlUnderlay *above);

/**
 * Fades each painted layer out where others that knock out lie over it and the nearest way out from
 * under them does not lead to it: dashes of a lower colour along an outline that both share, and
 * slivers of a pixel beside what lies above. Elsewhere, rims of what lies above are as they were.
 *
 * The n layers, bottom first, lie below those that came before. They are those that
 * fl_layers_resolve() takes, and come here before it; alpha of rgba and knockout change. Returns:
 * false with FL_ERROR_NO_MEMORY set.
 */
bool fl_underlay_fade_next(FlUnderlay *above, FlLayer *layers, int n, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlUnderlay, fl_underlay_clear)

#endif
