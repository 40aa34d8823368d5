/* Gaussian blur of a plane. */
#ifndef FLUIDY_GUIDES_BLUR_H
#define FLUIDY_GUIDES_BLUR_H

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * Blurs a plane in place with a Gaussian that is cut at three sigma. Pixels beyond the plane count
 * as their nearest pixel in it; sigma_px > 0.
 */
bool fl_blur(float *plane, int width, int height, float sigma_px, GError **error);

#endif
