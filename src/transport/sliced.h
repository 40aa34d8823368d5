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

/** The places of a target's patches, by level: corners y * width + x in scan order. */
typedef struct FlSlicedPlaces {
    int width, height;
    GArray *level[FL_SLICED_LEVELS]; // of uint32_t
} FlSlicedPlaces;

/** All places. Sides are multiples of 1 << (FL_SLICED_LEVELS - 1). */
void fl_sliced_places_init(FlSlicedPlaces *places, int width, int height);
void fl_sliced_places_clear(FlSlicedPlaces *places);

/** A density to be judged. */
typedef struct FlSlicedTarget {
    const float *density; // of the places' size
    const FlSlicedPlaces *places;
} FlSlicedTarget;

/**
 * The mean squared distance from the style of `samples` patches in `directions` directions, both
 * drawn by `key`, on the levels of the bit set, summed; a level with fewer than 64 places for
 * patches does not count. Everything is periodic.
 *
 * by_density: the derivative is written; NULL: it is not wanted.  * Returns: below 0 with
 * FL_ERROR_NO_MEMORY set.
 */
float fl_sliced_loss(const FlSliced *sliced, const FlSlicedTarget *target, unsigned levels,
                     int samples, int directions, uint64_t key, float *by_density, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSliced, fl_sliced_free)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlSlicedPlaces, fl_sliced_places_clear)

#endif
