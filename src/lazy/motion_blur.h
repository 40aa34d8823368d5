/* Motion blur of an output along its flow [L15 §4.5, fig. 9]. */
#ifndef FLUIDY_LAZY_MOTION_BLUR_H
#define FLUIDY_LAZY_MOTION_BLUR_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

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

#endif
