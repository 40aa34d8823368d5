/* Colourising: from the exemplar's paint to paint in the drawing's own colours. */
#pragma once

#include "base/rect.h"
#include "compose/ink.h"
#include "params/region_settings.h"

/**
 * The colouring of one region of one frame.
 *
 * Amounts of paint have the colours of colour_law.h for the fill, or those of the exemplar on the
 * output's paper.
 */
typedef struct FlColouring {
    FlTint tint;
    uint8_t fill[3];        // the flat colour
    const uint8_t *picture; // of the area's box, RGBA whose alpha is not read; or NULL
    uint8_t paper[3];       // the output's paper
    FlMedium medium;        // the opacity of the paint
    const int8_t *play;     // of the box: of fl_wash_lay(); NULL: paint of one pigment
    float turn[3];          // ln of a factor, by channel, where the second pigment prevails by one
    float reach[2];         // 0..1: share of it towards the first pigment, and towards the second
    bool linear;            // the layers will be blended in linear light
} FlColouring;

/** The paint in a part of the frame that holds the area's box: 3 bytes of sRGB a pixel.
 */
typedef struct FlPaintedPart {
    const uint8_t *rgb;
    FlRect box;
    const uint8_t *alpha; // of the box: how far the paint hides, whatever its amount; or NULL
} FlPaintedPart;

/**
 * The amounts of paint of an area, one per pixel of its box; -1 where coverage is 0 and beyond the
 * area. exposure is of fl_ink_exposure(); FL_EXPOSURE_ONE: as in the exemplar. coverage is of the
 * box.
 */
void fl_colourise_amounts(const FlInk *ink, int exposure, const FlPaintedPart *painted,
                          const uint8_t *coverage, const FlArea *area, int16_t *amounts);

/**
 * Colours the pixels of an area that have an amount of paint, 0 or more.
 *
 * The colours in painted are read for FL_TINT_KEEP only. rgba, four bytes per pixel of the box,
 * becomes straight RGBA: the paint alone, without the coverage. Over the paper it has the painted
 * colour in every medium. Alpha is, and in a fill never falls as the amount a rises:
 *
 *     transparent  the least with which that is so, so that thin paint is a glaze
 *     opaque       at least 1 - 2^-4a: the fill's own colour, and thin places let through
 *     body         at least 5a: as if painted on the paper and cut out with it
 *     solid        all
 *
 * Paint with alpha of its own has that instead, and the exemplar's own colours are as they are.
 *
 * The other pixels, which were 0, are 0.
 */
void fl_colourise(const FlInk *ink, const FlColouring *colouring, const FlPaintedPart *painted,
                  const int16_t *amounts, const FlArea *area, uint8_t *rgba);

/**
 * Colours shapes that are drawn and not painted, as opaque paint: the picture's colours, or the
 * flat one if NULL. picture and coverage are of the box. Pixels without coverage stay as they are.
 */
void fl_colourise_plain(const uint8_t *picture, const uint8_t flat[3], const uint8_t *coverage,
                        const FlArea *area, uint8_t *rgba);
