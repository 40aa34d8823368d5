/* Colour maps for numbers and vectors. */
#pragma once

#include <stdint.h>

/** 0 … 1 from dark violet over green to yellow, in even steps of lightness; clamped. */
void fl_colour_map(float value, uint8_t rgb[3]);

/** A vector as a colour: its direction is the hue, its length as a share of `most` the saturation.
 */
void fl_colour_wheel(float u, float v, float most, uint8_t rgb[3]);
