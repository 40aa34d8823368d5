/*
 * The loss that a density has against a style: the sliced Wasserstein distance of their patches, by
 * level of a pyramid. No trained network is needed.
 */
#ifndef FLUIDY_TRANSPORT_SLICED_H
#define FLUIDY_TRANSPORT_SLICED_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

#define FL_SLICED_LEVELS 5
#define FL_SLICED_PATCH 7       // px; on each level
#define FL_SLICED_DIRECTIONS 96 // in which patches are projected

/** A style's distribution: sorted responses by level and direction. */
typedef struct FlSliced FlSliced;

/**
 * Learns a picture of densities of mean 1, width * height.
 * Returns: to be freed with fl_sliced_free(); NULL with FL_ERROR_NO_MEMORY set, or FL_ERROR_STYLE
 * if the picture is smaller than 32 px.
 */
FlSliced *fl_sliced_new(const float *density, int width, int height, GError **error);
void fl_sliced_free(FlSliced *sliced); // NULL is fine

/**
 * The mean squared distance of a density, width * height and periodic, from the style: of `samples`
 * patches in `directions` directions, both drawn by `key`, on the levels of the bit set, summed; a
 * level with fewer than 64 pixels does not count.
 *
 * width, height: multiples of 1 << (FL_SLICED_LEVELS - 1). by_density: the derivative is written;
 * NULL: it is not wanted. Returns: below 0 with FL_ERROR_NO_MEMORY set.
 */
float fl_sliced_loss(const FlSliced *sliced, const float *density, int width, int height,
                     unsigned levels, int samples, int directions, uint64_t key, float *by_density,
                     GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSliced, fl_sliced_free)

#endif
