/* The channels of LazyFluids as float planes, their pyramid, and what is packed of them. */
#pragma once

#include "synth/fluid_texel.h"
#include <fluidy/error.h>
#include <stdbool.h>

/** Planes of 0 … 1, in the order of an exemplar's pixel. */
typedef enum FlFluidPlane {
    FL_FLUID_PLANE_COLOUR, // red, green, blue and alpha
    FL_FLUID_PLANE_EDGE = 4,
    FL_FLUID_PLANE_PAST, // the four of the frame before
    FL_FLUID_PLANE_WEIGHT = 9,
    FL_FLUID_PLANES
} FlFluidPlane;

/** One level; planes are row-major, width * height. */
typedef struct FlFluidPlanes {
    int width, height;
    float *plane[FL_FLUID_PLANES]; // NULL: absent, equal to a plane of zeros
    float *all;                    // the memory of the present planes
} FlFluidPlanes;

/** Makes planes `first` to `end`, without the latter. */
bool fl_fluid_planes_init(FlFluidPlanes *planes, int width, int height, int first, int end,
                          GError **error);
void fl_fluid_planes_clear(FlFluidPlanes *planes);

/** Makes `coarse` by averaging 2x2 pixels, in half the size, rounded up. */
bool fl_fluid_planes_halve(const FlFluidPlanes *fine, FlFluidPlanes *coarse, GError **error);

/** Blurs plane FL_FLUID_PLANE_EDGE, in which the mask stands [L15 §4.2]. */
bool fl_fluid_planes_blur(FlFluidPlanes *planes, float sigma_px, GError **error);

/** The terms' weights in (9): eta and lambda; colour has weight 1, alpha weight 3. */
typedef struct FlFluidWeights {
    float edge, past;
} FlFluidWeights;

bool fl_fluid_picture_init(FlFluidPicture *picture, int width, int height, GError **error);
void fl_fluid_picture_clear(FlFluidPicture *picture);

/** Packs the planes that are there into a picture that has been made in their size. */
void fl_fluid_picture_pack(const FlFluidPlanes *planes, const FlFluidWeights *weights,
                           const FlFluidPicture *picture);

/** Packs row y of the colours and alpha, 4 floats per pixel. */
void fl_fluid_picture_pack_row(const float *rgba, int y, const FlFluidPicture *picture);

#define FL_FLUID_LOWER 0.1f // l: blurred alpha from which on there is fluid [L15 §5]
#define FL_FLUID_UPPER 0.9f // u: blurred alpha from which on it is interior

/** Parts of the fluid, matched for themselves [L15 §4.2]. */
typedef struct FlFluidSegments {
    uint32_t *place[2]; // border, interior: row * width + column, ascending
    size_t n[2];
} FlFluidSegments;

/**
 * The pixels whose blurred alpha is above FL_FLUID_LOWER: of the interior from FL_FLUID_UPPER on,
 * if their patch lies inside the contour. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_fluid_segments_init(FlFluidSegments *segments, const FlFluidPlanes *planes, GError **error);
void fl_fluid_segments_clear(FlFluidSegments *segments);

/** Makes one segment of both, the first. */
bool fl_fluid_segments_merge(FlFluidSegments *segments, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFluidPlanes, fl_fluid_planes_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFluidPicture, fl_fluid_picture_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlFluidSegments, fl_fluid_segments_clear)
