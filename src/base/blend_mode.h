/* The blend modes of SVG [Compositing and Blending Level 1, §10]. */
#pragma once

#include <stdint.h>

/** The mode by which a colour is blended with the backdrop. */
typedef enum FlBlendMode {
    FL_BLEND_MODE_OVER, // "normal"
    FL_BLEND_MODE_MULTIPLY,
    FL_BLEND_MODE_SCREEN,
    FL_BLEND_MODE_OVERLAY,
    FL_BLEND_MODE_DARKEN,
    FL_BLEND_MODE_LIGHTEN,
    FL_BLEND_MODE_DODGE,
    FL_BLEND_MODE_BURN,
    FL_BLEND_MODE_HARD_LIGHT,
    FL_BLEND_MODE_SOFT_LIGHT,
    FL_BLEND_MODE_DIFFERENCE,
    FL_BLEND_MODE_EXCLUSION,
    FL_BLEND_MODE_HUE,
    FL_BLEND_MODE_SATURATION,
    FL_BLEND_MODE_COLOUR,
    FL_BLEND_MODE_LUMINOSITY,
    FL_N_BLEND_MODES
} FlBlendMode;

/**
 * Replaces the sRGB colour rgb, so that normal compositing over the backdrop shows the blend mode.
 *
 * backdrop_alpha is 0..255; rgb stays as it is where that is 0.
 */
void fl_blend_mode_apply(FlBlendMode mode, const uint8_t backdrop[3], int backdrop_alpha,
                         uint8_t rgb[3]);
