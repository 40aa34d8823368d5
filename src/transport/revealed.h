/*
 * Finds areas that one shape of a region hid in the frame before and reveals now: their material is
 * not that of the place from which the motion leads.
 */
#ifndef FLUIDY_TRANSPORT_REVEALED_H
#define FLUIDY_TRANSPORT_REVEALED_H

#include "guides/guides.h"
#include "transport/material.h"

/** By pixel of a material's rectangle. */
struct FlRevealed {
    FlMaterial motion; // in place of shifts: motion of the content into the frame, px; unknown: 0
    float *apart;      // 0: seen before; above: revealed, px that the other shape moved differently
};

/**
 * Finds what is revealed in `rect` of the next frame. Two shapes that move apart claim one place of
 * the frame before; it was the one's whose motion has changed less. `before` is the motion of the
 * last frame; without shifts the result is empty. Errors: FL_ERROR_NO_MEMORY.
 */
bool fl_revealed_find(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                      FlRevealed *revealed, GError **error);

/**
 * Gives revealed pixels the shifts of neighbours that move alike; without such neighbours the
 * shifts stay. Errors: FL_ERROR_NO_MEMORY.
 */
bool fl_revealed_fill(const FlRevealed *revealed, const FlGuides *guides, float *shift,
                      GError **error);

void fl_revealed_clear(FlRevealed *revealed);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlRevealed, fl_revealed_clear)

#endif
