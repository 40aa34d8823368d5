/* The state that a region in LazyFluids carries to its next frame, and its form as bytes. */
#pragma once

#include "lazy/warp.h"
#include "synth/guide_pairs.h"

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

/* ---- what is made of its frames ---- */

/**
 * The pairs of a frame [L15 (9)]: blurred alpha, segments, and the past's colours and alpha, if
 * there is one, each with its weight; planes are those of level 0. The style is the exemplar's
 * frame with its alpha; multiplied: planes have colours times alpha, and the style straight ones.
 * paper: sRGB, of colours where there is no fluid.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set; pairs need clearing in any case.
 */
bool fl_lazy_pairs(const FlFluidPlanes *source, const FlFluidPlanes *target,
                   const FlFluidWeights *weights, const uint8_t paper[3], bool multiplied,
                   FlGuidePairs *pairs, GError **error);

/**
 * Line integral along the motion with a Gaussian of a quarter of shutter * |motion| px, cut at two
 * sigma, of at most 65 samples. rgba: 4 * width * height; colours weigh by their alpha, unless they
 * are multiplied by it. motion: 2 per pixel, NAN for no motion. Pixels without motion stay
 * unchanged.
 *
 * Returns: a picture like rgba, to be freed with free(); NULL with FL_ERROR_NO_MEMORY set.
 */
uint16_t *fl_motion_blur(const uint16_t *rgba, const float *motion, int width, int height,
                         bool multiplied, float shutter, GError **error);
