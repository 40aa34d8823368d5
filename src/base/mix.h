/* The blend modes of SVG [Compositing and Blending Level 1, §10]. */
#ifndef FLUIDY_BASE_MIX_H
#define FLUIDY_BASE_MIX_H

#include <stdint.h>

/** How a colour is mixed with what lies below it. */
typedef enum FlMix {
    FL_MIX_OVER, // "normal"
    FL_MIX_MULTIPLY,
    FL_MIX_SCREEN,
    FL_MIX_OVERLAY,
    FL_MIX_DARKEN,
    FL_MIX_LIGHTEN,
    FL_MIX_DODGE,
    FL_MIX_BURN,
    FL_MIX_HARD_LIGHT,
    FL_MIX_SOFT_LIGHT,
    FL_MIX_DIFFERENCE,
    FL_MIX_EXCLUSION,
    FL_MIX_HUE,
    FL_MIX_SATURATION,
    FL_MIX_COLOUR,
    FL_MIX_LUMINOSITY,
    FL_N_MIXES
} FlMix;

/**
 * The colour which, laid over sRGB `below` as usual, shows `rgb` mixed with it: changes rgb.
 *
 * drawn is the opacity of what lies below, 0..255: where nothing does, every colour stays.
 */
void fl_mix(FlMix mix, const uint8_t below[3], int drawn, uint8_t rgb[3]);

#endif
