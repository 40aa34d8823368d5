/* Gaussian blur of a plane. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * One side of a symmetric kernel. Weighted sums are divided by `sum`, which is 1 for weights that
 * add up to 1. Who blurs makes the kernel: a last bit of it would change every style that was
 * imported and every picture of the papers' presets.
 */
typedef struct FlBlurKernel {
    int radius;          // px, >= 0
    const float *weight; // radius + 1, from the middle outwards
    float sum;
} FlBlurKernel;

/**
 * Blurs a plane in place, along x, then along y. Pixels beyond the plane count as the nearest pixel
 * of the plane. The same bytes on every processor and thread count. FL_ERROR_NO_MEMORY.
 */
bool fl_blur_with(float *plane, int width, int height, const FlBlurKernel *kernel, GError **error);

/** The same with a Gaussian that is cut at three sigma; sigma_px > 0. */
bool fl_blur(float *plane, int width, int height, float sigma_px, GError **error);
