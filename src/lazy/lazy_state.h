/* The state that a region in LazyFluids carries to its next frame, and its form as bytes. */
#ifndef FLUIDY_LAZY_LAZY_STATE_H
#define FLUIDY_LAZY_LAZY_STATE_H

#include "lazy/warp.h"

typedef struct FlLazyState {
    int width, height;
    int frame;  // frames painted so far, >= 0
    bool valid; // the last frame had fluid; else the fields below are empty
    FlFluidPast past;
    uint8_t *shape; // fl_rest_shape()
} FlLazyState;

/** Frees the fields that only exist after a frame with fluid. */
void fl_lazy_state_forget(FlLazyState *state);

/** In this machine's byte order. Returns: NULL with FL_ERROR_NO_MEMORY set. */
GBytes *fl_lazy_state_pack(const FlLazyState *state, GError **error);

/** The reverse, for an exemplar whose level 0 is `level`; the bytes need not be trusted. Returns:
 * false with FL_ERROR_CHANGED set; the next frame is then a first frame. */
bool fl_lazy_state_unpack(FlLazyState *state, GBytes *bytes, const FlExemplarLevel *level,
                          GError **error);

#endif
