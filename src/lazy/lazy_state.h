/* What the next frame of a region in LazyFluids needs from those before it; as bytes, too. */
#ifndef FLUIDY_LAZY_LAZY_STATE_H
#define FLUIDY_LAZY_LAZY_STATE_H

#include "lazy/warp.h"

typedef struct FlLazyState {
    int width, height;
    int frame;  // frames painted so far, >= 0
    bool valid; // the last of them had fluid; else the rest is not there
    FlFluidPast past;
    uint8_t *shape; // fl_rest_shape()
} FlLazyState;

/** Frees all that a frame without fluid, and so the first one, has none of. */
void fl_lazy_state_forget(FlLazyState *state);

/** In this machine's byte order. Returns: NULL with FL_ERROR_NO_MEMORY set. */
GBytes *fl_lazy_state_pack(const FlLazyState *state, GError **error);

/** The reverse, for an exemplar whose level 0 is `level`; the bytes need not be trusted. Returns:
 * false with FL_ERROR_CHANGED set; the next frame is then a first frame. */
bool fl_lazy_state_unpack(FlLazyState *state, GBytes *bytes, const FlExemplarLevel *level,
                          GError **error);

#endif
