/* The channels of one frame at one level as float planes, and their pyramid. */
#pragma once

#include "base/rect.h"
#include "guides/guides.h"
#include "synth/kernels.h"

/** The planes of a pyramid. A target has no colours of its own. */
typedef enum FlPlane {
    FL_PLANE_SHAPE,     // 0 … 1
    FL_PLANE_EXT_PLUS,  // level-0 px
    FL_PLANE_EXT_MINUS, // level-0 px
    FL_PLANE_DISTANCE,  // level-0 px, positive inside
    FL_PLANE_COS,       // direction of the flow
    FL_PLANE_SIN,
    FL_PLANE_INSIDE, // share of the pixel that lies in the mask, 0 … 1
    FL_PLANE_R,      // 0 … 1
    FL_PLANE_G,
    FL_PLANE_B,
    FL_PLANES
} FlPlane;

/** Planes are row-major, width * height, without padding. */
typedef struct FlPyramid {
    int width, height;
    float *plane[FL_PLANES]; // NULL from n_planes on
    int n_planes;
} FlPyramid;

bool fl_pyramid_init(FlPyramid *pyramid, int width, int height, int n_planes, GError **error);
void fl_pyramid_clear(FlPyramid *pyramid);

/** Borrows `height` rows of a pyramid from row y on. */
FlPyramid fl_pyramid_rows(const FlPyramid *pyramid, int y, int height);

/** Copies the rectangle's guides; `shape` is as large as the guides, NULL: its plane stays as it
 * is.
 */
void fl_pyramid_fill(FlPyramid *pyramid, const FlGuides *guides, const float *shape, FlRect rect);

/** Averages 2x2 pixels; extents and directions count where they lie in the mask. */
void fl_pyramid_halve(const FlPyramid *fine, FlPyramid *coarse);

/** Direction of the flow at a pixel, in 256 steps. */
uint8_t fl_pyramid_angle(const FlPyramid *pyramid, size_t pixel);

#define FL_EXT_UNIT 0.5f // extents are packed in halves: up to twice the source's maximum

/** A plane's value of 0 … 1 as a target's channel: rounded and clamped. */
static inline int16_t fl_pack_channel(float value)
{
    const float scaled = value * FL_ONE + 0.5f;
    return (int16_t)(scaled <= 0 ? 0 : scaled >= FL_ONE ? FL_ONE : scaled);
}

/** The same as an exemplar's channel. */
static inline uint8_t fl_texel_channel(float value)
{
    const float scaled = value * FL_TEXEL_ONE + 0.5f;
    return (uint8_t)(scaled <= 0 ? 0 : scaled >= FL_TEXEL_ONE ? FL_TEXEL_ONE : scaled);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlPyramid, fl_pyramid_clear)
