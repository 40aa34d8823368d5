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

/** Where a layer fades: its box and some pixels around it. */
typedef struct FlFading {
    FlRect box;
    bool half;
    uint8_t *over; // how far what covers the pixel from above hides, 0..255; 0: nothing does; NULL:
                   // the layer does not fade
    uint8_t *seen; // 1: the layer is seen
} FlFading;

/**
 * Finds where the next layer fades, and adds it to those above; the top one comes first. Its area,
 * its coverage and its stacking are enough; painted: it will get a knockout.
 *
 * A painted layer fades where others that knock out lie over it and the nearest way out from under
 * them does not lead to it: dashes of a lower colour along an outline that both share, and slivers
 * of a pixel beside what lies above. Elsewhere, rims of what lies above are as they were.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_underlay_next(FlUnderlay *above, const FlLayer *layer, bool painted, FlFading *fading,
                      GError **error);

/** Fades a painted layer: lowers its knockout and the alpha of its rgba, before it is resolved.
 * FL_ERROR_NO_MEMORY. */
bool fl_fading_apply(const FlFading *fading, FlLayer *layer, GError **error);

void fl_fading_clear(FlFading *fading);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlUnderlay, fl_underlay_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFading, fl_fading_clear)

#endif
