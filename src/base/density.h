/* Optical density in fixed point: logarithms of 8-bit colours and the way back, the same
 * everywhere. */
#pragma once

#include <stdint.h>

/** Densities are -log2(level / 255) in steps of 1 / FL_DENSITY_ONE. */
#define FL_DENSITY_ONE 65536

/** The density of level 0, for which the logarithm is infinite: that of half a level. */
#define FL_DENSITY_MAX 589451

/** The density of an 8-bit level: 0 for 255, FL_DENSITY_MAX for 0. */
int32_t fl_density(uint8_t level);

/** The level of a density, in 1/256 levels: 0..65280. A negative density counts as 0. */
uint16_t fl_density_level(int32_t density);

/** 16-bit linear light of an 8-bit sRGB level [IEC 61966-2-1], and the nearest level of a light. */
uint16_t fl_srgb_to_linear(uint8_t level);
uint8_t fl_srgb_from_linear(uint16_t light);
