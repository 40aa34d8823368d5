/* The exemplar as LazyFluids reads it: one frame and its predecessor, on every level. */
#pragma once

#include "lazy/fluid_planes.h"
#include "synth/exemplar.h"

typedef struct FlFluidLevel {
    FlFluidPicture picture;
    FlFluidSegments segments;
    FlExemplarLevel voted; // RGBA of one frame for fl_vote(); other fields are empty
} FlFluidLevel;

/** All 0: empty. */
typedef struct FlFluidExemplar {
    int n_levels, frame, before; // before: the frame of the past
    FlFluidLevel level[FL_MAX_LEVELS];
} FlFluidExemplar;

/**
 * Packs two frames of a style, colours as they are on its paper and alpha from the masks; of a
 * cut-out colours times its alpha. Packs the same frames again only for more levels. Both must be
 * in the exemplar's window. sigma_px: of the blur of alpha; it and weights must not change.
 */
bool fl_fluid_exemplar_pack(FlFluidExemplar *fluid, const FlExemplar *exemplar, int frame,
                            int before, int n_levels, float sigma_px, const FlFluidWeights *weights,
                            GError **error);
void fl_fluid_exemplar_clear(FlFluidExemplar *fluid);

/**
 * Makes the planes that are packed, on level 0. Returns: false with FL_ERROR_NO_MEMORY set; planes
 * need clearing in any case.
 */
bool fl_fluid_exemplar_planes(const FlExemplar *exemplar, int frame, int before, float sigma_px,
                              FlFluidPlanes *planes, GError **error);

/** Makes a picture for fl_vote(), to be filled channel by channel; `colour` is to be freed. */
bool fl_fluid_splines_init(FlExemplarLevel *level, int width, int height, GError **error);

/** Straightens the plane of channel c, which is overwritten. */
void fl_fluid_splines_fill(const FlExemplarLevel *level, int c, float *plane);
