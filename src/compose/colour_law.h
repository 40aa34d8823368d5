/* The colour law: which colour an amount of paint has, for a fill on a paper. */
#pragma once

#include <stdint.h>

/**
 * Paint that is darker than its paper. Levels are in 1/256 of an 8-bit one, densities those of
 * fl_density().
 */
typedef struct FlColourCurve {
    int32_t paper[3], fill[3]; // levels: no paint, and an amount of one
    int32_t thin[3];           // density of the fill over the paper that the way from one to the
                               // other bends by; 0: it is straight
    int32_t density[3];        // of the fill
    int32_t step[3];           // density that one more amount adds
    int32_t shade[3];          // the same beyond the fill's own, which ends at twice this
    int32_t knee;              // amount before and after one within which thin passes into thick
} FlColourCurve;

/** The law of one fill on one paper. */
typedef struct FlColourLaw {
    FlColourCurve dark;
    FlColourCurve light; // of the complements, 255 - level
    int32_t light_share; // fl_light_share()
} FlColourLaw;

/** The degree, 0 … 65536, to which a fill is light paint on dark paper: by L*, since by luma
 * magenta is dark. */
int32_t fl_light_share(const uint8_t fill[3], const uint8_t paper[3]);

/**
 * An amount of 0 is the paper, of one (FL_AMOUNT_ONE) the fill, to within 2.5 in CIEDE2000: white
 * and black move a little, so that paint thicker and thinner than the median differs from it.
 * Thicker paint is darker, by about 29 L* an amount; paint lighter than its paper goes the same way
 * in the negative. Greys are neutral from one on. Each channel goes one way up to one, or for near
 * white up to less, and one way beyond it, except where a fill is 5 to 18 L* lighter than its
 * paper: there the two directions are blended.
 *
 * spread is that of the style's paint (FlInk): saturated fills of uneven paint get less shade,
 * since in a corner of the gamut all texture takes chroma away.
 */
void fl_colour_law_init(FlColourLaw *law, const uint8_t fill[3], const uint8_t paper[3],
                        int spread);

/** The amount at which channels turn, if they do: up to it is thin paint, from it on thick. */
int fl_colour_law_turn(const FlColourLaw *law);

/** The colour of an amount 0 … FL_AMOUNTS - 1. */
void fl_colour_law_at(const FlColourLaw *law, int amount, uint8_t colour[3]);
