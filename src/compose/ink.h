/* The ink of a style: how much paint a colour of the exemplar stands for. */
#pragma once

#include "style/style_folder.h"

/**
 * Amounts of paint are fixed point, FL_AMOUNT_ONE to the unit; the exemplar's median interior has
 * amount one. Amounts are 0 … FL_AMOUNTS - 1: bare paper to eight times the median.
 */
#define FL_AMOUNT_ONE 1024
#define FL_AMOUNTS 8192

/** An exposure scales amounts; FL_EXPOSURE_ONE leaves them as they are. */
#define FL_EXPOSURE_ONE 4096
#define FL_EXPOSURE_MIN (FL_EXPOSURE_ONE / 4)
#define FL_EXPOSURE_MAX (FL_EXPOSURE_ONE * 8)

/**
 * The properties of a style's paint.
 *
 * The density of a colour S on paper P is -log(S/P) per channel. It is reduced to one number by
 * projecting it on the median interior density v of the exemplar, (D·v) / (v·v): the least-squares
 * estimate of how much of the style's typical paint lies there. Weights by luminance would nearly
 * ignore a yellow paint, whose texture is all in blue, and see the paper's noise instead.
 */
typedef struct FlInk {
    uint8_t paper[3];     // sRGB of the exemplar's bare paper
    int32_t part[3][256]; // amount * 256 that a level of a channel adds
    int32_t toe;          // amounts below this bend down, to 0 at toe_end; 0: no amount does
    int32_t toe_end;      // 0 … toe
    int32_t toe_share;    // of the bend that is taken, 0 … FL_AMOUNT_ONE
    int32_t shoulder;     // amounts above one end at one plus this; 0: no end
    int32_t density[3];   // of the median colour over the paper, by channel: FL_DENSITY_ONE
    int32_t mean;         // amount of the exemplar's interior; the median is FL_AMOUNT_ONE
    int32_t spread;       // half of what lies between the 16th and the 84th percentile
    int beyond;           // percent of the pixels on the paper's other side, which count as bare:
                          // lighter than the paper where the median is darker, or darker
} FlInk;

/**
 * Learns the ink from pixels of the exemplar: rgb has n_pixels * 3 bytes, mask n_pixels (coverage;
 * 128 and more is paint).
 *
 * Returns: to be freed with fl_ink_free(); NULL with FL_ERROR_STYLE if no paint differs from paper.
 */
FlInk *fl_ink_new(const uint8_t paper[3], const uint8_t *rgb, const uint8_t *mask, size_t n_pixels,
                  GError **error);

/** The same from all frames of a style; messages name it. */
FlInk *fl_ink_of_style(const FlStyle *style, GError **error);

void fl_ink_free(FlInk *ink); // NULL is fine

/** The amount of paint that a colour stands for, negative beyond the paper. */
static inline int fl_ink_signed_amount(const FlInk *ink, const uint8_t *rgb)
{
    return (ink->part[0][rgb[0]] + ink->part[1][rgb[1]] + ink->part[2][rgb[2]]) >> 8;
}

/** The same, 0 … FL_AMOUNTS - 1. */
static inline int fl_ink_amount(const FlInk *ink, const uint8_t *rgb)
{
    const int amount = fl_ink_signed_amount(ink, rgb);
    return amount < 0 ? 0 : amount < FL_AMOUNTS ? amount : FL_AMOUNTS - 1;
}

/**
 * The exposure that brings a painted region's own median amount to one.
 *
 * painted is width * height * 3, coverage width * height: how much each pixel counts. A region
 * takes other parts of the exemplar than its median (a thin limb is all rim, an early frame all
 * fresh paint), and without it its colour would not be the drawing's. Pixels count 16 times as much
 * 1 px inside the contour and 256 times 2 px inside: those at the contour matter in thin lines
 * only. It is a function of this frame alone.
 *
 * Returns: FL_EXPOSURE_MIN … FL_EXPOSURE_MAX.
 */
int fl_ink_exposure(const FlInk *ink, const uint8_t *painted, const uint8_t *coverage, int width,
                    int height);

/** The amount after exposure, toe and shoulder, 0 … FL_AMOUNTS - 1; it never falls as amount rises.
 */
int fl_ink_exposed(const FlInk *ink, int amount, int exposure);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlInk, fl_ink_free)
