/* The texels that LazyFluids compares: pixels of exemplar and target, packed for the retrieval [L15
 * §4]. */
#pragma once

#include "synth/rotation.h"
#include <stddef.h>
#include <stdint.h>

/** Channels of a pixel. Those of the past are the frame before: Z_(t-1) of the exemplar, and of the
 * target X^, the last output carried along the motion. */
enum {
    FL_FLUID_R,
    FL_FLUID_G,
    FL_FLUID_B,
    FL_FLUID_A,    // alpha: the exemplar's own, and of the target the synthesised one
    FL_FLUID_EDGE, // blurred alpha: where between the middle and the outside
    FL_FLUID_PAST = 8,
    FL_FLUID_PAST_A = FL_FLUID_PAST + 3,
    FL_FLUID_WEIGHT = 15, // of a target: how much its past counts, 0 … 32767; else 0
    FL_FLUID_CHANNELS
};

/** A pixel: values times FL_FLUID_ONE and the square root of their weight. */
typedef struct FlFluidTexel {
    _Alignas(32) int16_t c[FL_FLUID_CHANNELS];
} FlFluidTexel;

#define FL_FLUID_ONE 2040 // 1.0 with weight 1
/** The most that the weights of edge and past may add up to, eta + 6 lambda, so that the sum over a
 * patch stays below 2^32: 25 * 2040^2 * (3 + 3 + 35). */
#define FL_FLUID_WEIGHTS 35

/** A picture of such pixels with FL_PATCH_RADIUS more on every side, which repeat its border. */
typedef struct FlFluidPicture {
    int width, height;   // without them
    ptrdiff_t pitch;     // pixels from one row to the next
    FlFluidTexel *pixel; // of row 0, column 0
} FlFluidPicture;

/**
 * The squared distance (9) of a source patch to a target patch: over 25 pixels, the squared
 * differences of five channels and of the past's four, each of these first times the target's
 * weight and rounded, (d * w + 2^14) >> 15. `source` holds the patch row by row, as it is turned;
 * `target` is the first pixel of the patch.
 *
 * Returns: the sum; or, once it exceeds limit, any number above limit.
 */
typedef uint32_t (*FlFluidDistance)(const FlFluidTexel source[FL_PATCH_PIXELS],
                                    const FlFluidTexel *target, ptrdiff_t pitch, uint32_t limit);

uint32_t fl_fluid_distance_c(const FlFluidTexel source[FL_PATCH_PIXELS], const FlFluidTexel *target,
                             ptrdiff_t pitch, uint32_t limit);
uint32_t fl_fluid_distance_avx2(const FlFluidTexel source[FL_PATCH_PIXELS],
                                const FlFluidTexel *target, ptrdiff_t pitch, uint32_t limit);
