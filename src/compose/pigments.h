/* Pigments, and the two of them that mix to a fill. */
#pragma once

#include <stdint.h>

/** A pigment [C97 §5, fig. 5]; per unit of thickness. */
typedef struct FlPigment {
    const char *name;
    float absorption[3], scattering[3];   // K and S, > 0, per sRGB channel
    float density, staining, granulation; // rho, omega > 0, gamma 0..1
    float diffusion; // rate of spreading in standing water, cells^2 per step, 0..0.2
} FlPigment;

/** A pigment by name. Returns: static storage; NULL for an unknown name. */
const FlPigment *fl_pigment_find(const char *name);

/** All of them, static. Returns: their number. */
int fl_pigments(const FlPigment **all);

/** The mixture of two pigments that is nearest to a fill. */
typedef struct FlMixture {
    const FlPigment *pigment[2];
    double share, thickness; // share of the second one, 0..1
    uint8_t rgb[3];          // its colour on the paper
    float turn[3]; // ln of a factor on each channel: one CIE76 of hue towards the second pigment
} FlMixture;

/** The mixture for a fill: hue counts most, then lightness. Any thread; each fill is searched once.
 */
FlMixture fl_mixture_of(const uint8_t fill[3]);
