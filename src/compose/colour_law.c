#include "compose/colour_law.h"
#include "base/density.h"
#include "compose/ink.h"

/*
 * P (F/P)^a alone, Beer and Lambert's law per channel, shows no texture where a channel is at an
 * end: near 0 it has no slope left below one, and at 255 it cannot fall above. So thin paint bends
 * no more than THIN allows, thick paint counts its density from a white as light as the paper, and
 * where that changes the lightness too little it is shaded. Counted from the paper itself, a thick
 * light grey on cream would be lavender. Constants were found on 13 fills in six styles.
 */
enum {
    DARKEST = 12,          // levels; a channel of 0 has no density, and real black is no darker
    DARKEST_NEGATIVE = 8,  // the same in the negative
    THIN = 113835,         // density of 0.30: thinner paint has slope left in every channel
    STRAIGHT = 4096,       // density of 0.957: below it the way is straight, and so well divided
    HEADROOM = 2836,       // density of exp(-0.03), by which light greys give way to thin paint
    EVEN_SPREAD = 700,     // spread (0.68) from which on saturated fills are shaded less
    FAINT = 5673,          // density of .06: of fainter fills the hue hardly counts
    LIGHT_AT = 5 * 256,    // L* / 256 above the paper's from where on a fill may be light paint,
    LIGHT_OVER = 13 * 256, // and over which it becomes so altogether
    FALL = 7 * 256         // L* / 256 from the paper down to the fill over which the knee goes
};

static const int32_t weight[3] = {13933, 46871, 4732}; // of linear light in Y [BT.709], / 65536

#define FRACTION 256 // shares, saturation and L* are in 1/256

static int64_t clamp_share(int64_t share)
{
    return CLAMP(share, 0, FRACTION);
}

/** The integer cube root by Newton's method from above; 0 <= n < 2^60. */
static int64_t cube_root(int64_t n)
{
    int64_t x = 1 << 20, next = x;
    do {
        x = next;
        next = x > 0 ? (2 * x + n / (x * x)) / 3 : 0;
    } while (next < x);
    return x;
}

/** L* + 16 of a luminance 0..65535, by the cube root alone; below L* = 8 it is up to 1 less. */
static int64_t lightness16(int64_t luminance)
{
    return 116 * FRACTION * cube_root(luminance << 44) >> 20;
}

/** Linear light of a level in 1/256. */
static int64_t light_of(int32_t level)
{
    const int s = level >> 8, rest = level & 255;
    const int64_t from = fl_srgb_to_linear((uint8_t)s);
    return rest ? from + (fl_srgb_to_linear((uint8_t)(s + 1)) - from) * rest / 256 : from;
}

static int64_t luminance_of(const int32_t level[3])
{
    int64_t sum = 0;
    for (int c = 0; c < 3; c++)
        sum += weight[c] * light_of(level[c]);
    return sum >> 16;
}

/** L* + 16 of a colour, 16 for black. */
static int64_t lightness16_of(const uint8_t rgb[3])
{
    const int32_t level[3] = {rgb[0] * 256, rgb[1] * 256, rgb[2] * 256};
    return MAX(lightness16(luminance_of(level)), 16 * FRACTION);
}

/** The lightness of a fill, and the speed at which more of the fill's density darkens the
 * colour. */
typedef struct Lightness {
    int64_t lightness16; // L* + 16
    int64_t slope;       // L* an amount
    int64_t step;        // density an amount, the mean of the channels by their light
} Lightness;

/** L* changes by (L* + 16) / 3 for a relative change of luminance, which is that of light: the
 * power 2.2 of levels. 33312 is 2.2 ln 2 / 3 * 65536. */
#define L_OF_OCTAVE 33312

static Lightness lightness_of(const FlColourCurve *curve)
{
    const int64_t luminance = MAX(luminance_of(curve->fill), 1);
    int64_t mean = 0;
    for (int c = 0; c < 3; c++)
        mean += weight[c] * light_of(curve->fill[c]) / luminance * curve->step[c];
    Lightness light = {.lightness16 = lightness16(luminance), .step = mean >> 16};
    light.slope = (light.lightness16 * L_OF_OCTAVE >> 16) * (mean >> 16) >> 16;
    return light;
}

/** Takes the fill by its density, for a white of density `white`. */
static void set_fill(FlColourCurve *curve, int32_t white)
{
    for (int c = 0; c < 3; c++) {
        curve->fill[c] = fl_density_level(curve->density[c]);
        curve->step[c] = MAX(curve->density[c] - white, 0);
    }
}

/** 0 for grey, FRACTION for a primary. */
static int64_t saturation_of(const uint8_t fill[3])
{
    const int most = MAX(MAX(fill[0], fill[1]), fill[2]);
    const int least = MIN(MIN(fill[0], fill[1]), fill[2]);
    return most > 0 ? FRACTION * (most - least) / most : 0;
}

/** The nearness of a fill to white: light, and not saturated. */
static int64_t whiteness_of(int64_t lightness16, int64_t saturation)
{
    return clamp_share((lightness16 - 100 * FRACTION) / 10) *
           clamp_share(FRACTION - saturation * 5 / 2) / FRACTION;
}

/** The slope in L* that the fill should have: 30, for near white 24. */
static int64_t wanted_slope(int64_t whiteness, int64_t saturation, int spread)
{
    const int64_t slope = 30 * (FRACTION - whiteness / 5);
    const int64_t uneven = spread > EVEN_SPREAD ? FRACTION - FRACTION * EVEN_SPREAD / spread : 0;
    return slope - slope * saturation * uneven / (FRACTION * FRACTION);
}

/** Gives thick paint the shade that it lacks; a thick yellow goes to ochre instead of olive. */
static void set_shade(FlColourCurve *curve, const Lightness *light, int64_t slope,
                      const uint8_t fill[3])
{
    const int64_t lack = MAX(slope - light->slope, 0);
    const int64_t shade = (lack << 32) / (light->lightness16 * L_OF_OCTAVE);
    const int yellow = MAX(MIN(fill[0], fill[1]) - fill[2], 0); // of 255
    curve->shade[0] = (int32_t)(shade * (25500 - 45 * yellow) / 25500);
    curve->shade[1] = (int32_t)(shade * (25500 + 16 * yellow) / 25500);
    curve->shade[2] = (int32_t)shade;
}

/** Divides most of the shade among the channels as the fill's own density is: it gets purer, and
 * darkens as much as before. */
static void make_shade_pure(FlColourCurve *curve)
{
    const Lightness light = lightness_of(curve);
    const int64_t luminance = MAX(luminance_of(curve->fill), 1);
    int64_t share[3], mean = 0;
    for (int c = 0; c < 3; c++) {
        const int64_t own = (curve->step[c] + FAINT) * FRACTION / (light.step + FAINT);
        share[c] = 2 * FRACTION + 3 * MIN(own, 3 * FRACTION);
        mean += weight[c] * light_of(curve->fill[c]) / luminance * share[c];
    }
    for (int c = 0; c < 3; c++)
        curve->shade[c] = (int32_t)(curve->shade[c] * share[c] / MAX(mean >> 16, 1));
}

/** The density of a neutral white as light as the paper. */
static int32_t white_of(const uint8_t paper[3])
{
    const int32_t level = weight[0] * paper[0] + weight[1] * paper[1] + weight[2] * paper[2];
    const int s = level >> 16, rest = level & 65535;
    const int32_t from = fl_density((uint8_t)MAX(s, 1));
    return s > 0 && rest > 0
               ? from + (int32_t)((int64_t)(fl_density((uint8_t)(s + 1)) - from) * rest / 65536)
               : from;
}

/** No fill is darker than `darkest`, unless its paper is. */
static uint8_t lifted(uint8_t fill, uint8_t paper, int darkest)
{
    return (uint8_t)MAX(fill, MAX(MIN(darkest, paper), 1));
}

/**
 * The amount about one within which thin paint passes into thick: a white that is no darker than
 * its paper has no texture below one, and half of it would be flat. `room` is in 1 / FRACTION^2.
 */
static int32_t knee_of(int64_t whiteness, int64_t rise, int64_t room)
{
    const int64_t flat = FRACTION * CLAMP(FALL + rise, 0, FALL) / FALL;
    return (int32_t)(FL_AMOUNT_ONE / 2 * flat * whiteness / (FRACTION * FRACTION) *
                     (FRACTION * FRACTION - room) / (FRACTION * FRACTION));
}

static void curve_init(FlColourCurve *curve, const uint8_t rgb[3], const uint8_t paper[3],
                       int darkest, int spread)
{
    const int32_t white = white_of(paper);
    uint8_t fill[3];
    for (int c = 0; c < 3; c++) {
        fill[c] = lifted(rgb[c], paper[c], darkest);
        curve->density[c] = fl_density(fill[c]);
    }
    set_fill(curve, white);
    const int64_t saturation = saturation_of(fill);
    Lightness light = lightness_of(curve);
    const int64_t whiteness = whiteness_of(light.lightness16, saturation);
    const int64_t slope = wanted_slope(whiteness, saturation, spread);
    const int64_t rise = light.lightness16 - lightness16_of(paper);
    const int64_t room = clamp_share(FRACTION - light.slope * FRACTION / slope) *
                         clamp_share(FRACTION - 2 * saturation) / FRACTION *
                         clamp_share(FRACTION - rise / 3);
    for (int c = 0; c < 3; c++)
        curve->density[c] += (int32_t)(HEADROOM * room / (FRACTION * FRACTION));
    set_fill(curve, white);
    light = lightness_of(curve);
    set_shade(curve, &light, slope, fill);
    curve->knee = knee_of(whiteness, rise, room);
    for (int c = 0; c < 3; c++) {
        const int32_t thin = curve->density[c] - fl_density(MAX(paper[c], 1));
        curve->paper[c] = paper[c] * 256;
        curve->thin[c] = thin < STRAIGHT ? 0 : MIN(thin, THIN);
    }
}

/**
 * The progress of a channel that is lighter than the paper, 0 … 2^30. It turns at an amount of
 * one, so that half of all paint would be well below the fill if its way were straight: a cubic is
 * there early. The median of near white moved by up to 4.2 in CIEDE2000, and moves by 2.2.
 */
static int64_t rising_share(int amount)
{
    const int64_t rest = FL_AMOUNT_ONE - amount;
    return (1 << 30) - rest * rest * rest;
}

/** From no paint to the fill, for an amount up to one. */
static int32_t thin_level(const FlColourCurve *curve, int c, int amount)
{
    const int64_t way = curve->fill[c] - curve->paper[c];
    const int32_t thin = curve->thin[c];
    if (thin == 0 && way <= 0)
        return (int32_t)(curve->paper[c] + way * amount / FL_AMOUNT_ONE);
    if (way > 0)
        return (int32_t)(curve->paper[c] + (way * rising_share(amount) >> 30));
    const int32_t full = 65280 - fl_density_level(thin);
    const int32_t part =
        65280 - fl_density_level((int32_t)((int64_t)thin * amount / FL_AMOUNT_ONE));
    return (int32_t)(curve->paper[c] + (way * part - full / 2) / full);
}

/** For an amount of one and `more`. */
static int32_t thick_level(const FlColourCurve *curve, int c, int64_t more)
{
    const int64_t two = 2 * FL_AMOUNT_ONE, ending = more * two / (two + more);
    const int64_t density =
        curve->density[c] + (more * curve->step[c] + ending * curve->shade[c]) / FL_AMOUNT_ONE;
    return fl_density_level((int32_t)MIN(density, FL_DENSITY_MAX));
}

/** The excess over one of an amount: it begins as a parabola. */
static int64_t more_than_one(int64_t amount, int64_t knee)
{
    const int64_t more = amount - FL_AMOUNT_ONE;
    return more >= knee ? more : (more + knee) * (more + knee) / (4 * knee);
}

/** The amount at which thin paint ends. */
static int turn_of(const FlColourCurve *curve)
{
    return FL_AMOUNT_ONE - curve->knee;
}

static int32_t level_at(const FlColourCurve *curve, int c, int amount)
{
    const int turn = turn_of(curve);
    return amount < turn ? thin_level(curve, c, amount * FL_AMOUNT_ONE / turn)
                         : thick_level(curve, c, more_than_one(amount, curve->knee));
}

int32_t fl_light_share(const uint8_t fill[3], const uint8_t paper[3])
{
    const int64_t rise = lightness16_of(fill) - lightness16_of(paper);
    const int64_t u = CLAMP(rise - LIGHT_AT, 0, LIGHT_OVER) * 65536 / LIGHT_OVER;
    return (int32_t)((u * u >> 16) * (3 * 65536 - 2 * u) >> 16);
}

void fl_colour_law_init(FlColourLaw *law, const uint8_t fill[3], const uint8_t paper[3], int spread)
{
    law->light_share = fl_light_share(fill, paper);
    if (law->light_share < 65536) {
        curve_init(&law->dark, fill, paper, DARKEST, spread);
        make_shade_pure(&law->dark); // light paint would clip to primaries
    }
    if (law->light_share == 0)
        return;
    uint8_t other_fill[3], other_paper[3];
    for (int c = 0; c < 3; c++)
        other_fill[c] = 255 - fill[c], other_paper[c] = 255 - paper[c];
    curve_init(&law->light, other_fill, other_paper, DARKEST_NEGATIVE, spread);
}

int fl_colour_law_turn(const FlColourLaw *law)
{
    return turn_of(law->light_share < 32768 ? &law->dark : &law->light);
}

void fl_colour_law_at(const FlColourLaw *law, int amount, uint8_t colour[3])
{
    const int64_t light = law->light_share;
    for (int c = 0; c < 3; c++) {
        int64_t level = light < 65536 ? (65536 - light) * level_at(&law->dark, c, amount) : 0;
        if (light > 0)
            level += light * (65280 - level_at(&law->light, c, amount));
        colour[c] = (uint8_t)((level + (1 << 23)) >> 24);
    }
}
