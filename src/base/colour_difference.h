/* The visible difference of two colours. */
#pragma once

#include <stdint.h>

/** CIE 1976 L*a*b* of an sRGB colour, D65; levels are 0..255. */
void fl_lab(const float level[3], float lab[3]);

/** CIE76 difference: 2 is just visible, 10 another shade, 30 another colour. */
float fl_colour_difference(const uint8_t a[3], const uint8_t b[3]);

/** A plain word such as "brown" or "dark-green"; static storage. */
const char *fl_colour_word(const uint8_t rgb[3]);
