/* Paint is wet where it is new or moves, and dries: the exemplar shows it fresh and dry. */
#pragma once

#include "synth/carry.h"

/** The input of a frame's drying. */
typedef struct FlDrying {
    const FlGuides *guides; // of the frame
    float unit_px;          // 1/480 of the page's larger side
    int width;              // of the frame
    float wets;             // of the exemplar
    int plays;              // frames of the exemplar that paint shows by its age; 0: it dries
    const uint8_t *before;  // for paint that plays: its wetness in the frame before; NULL: none
} FlDrying;

#define FL_TONE_ONE 128

/** The wetness of a pixel of guides at rest; plays: of paint that shows its age. */
int fl_wet_at_rest(const FlGuides *guides, size_t pixel, float unit_px, bool plays);

/**
 * Computes the wetness of all pixels of a rectangle. `carried` holds the pixels as they come from
 * the previous frame; NULL in a first frame, whose paint is as wet as after a long time of this
 * motion.
 *
 * Inside, paint is wetter the faster it moves; near the contour it is fresh where that advances and
 * dry where it recedes. It gets wet within two frames, dries within 36, and starts fresh where it
 * is new; paint of a body that comes into view at a side of the page is not new. wet: of the frame,
 * 0 elsewhere. tone: of rect, the factor of its density, FL_TONE_ONE is 1: fresh paint is pale, and
 * pigment gathers where the contour recedes.
 *
 * Paint that plays is as wet as can be where it comes in from outside the mask, and loses as much
 * freshness with each frame as there is between two frames of the exemplar; its tone is 1. So what
 * a fluid brings in is young at its source.
 *
 * Returns: true if the wetness of a pixel differs from its wetness at rest.
 */
bool fl_drying_step(const FlDrying *drying, FlRect rect, const FlCarried *carried, uint8_t *wet,
                    uint8_t *tone);

/**
 * Moves carried matches forward or back in the exemplar's time, from their wetness to `wet`. They
 * keep their place; beside a rim, which moves in the exemplar, they keep their depth. They stop
 * where the exemplar has no paint of their segment.
 */
void fl_drying_show(const FlDrying *drying, FlRect rect, const uint8_t *wet,
                    const FlExemplar *exemplar, FlCarried *carried);

/**
 * Multiplies the density of a picture's paint, on its paper, by a tone of rect; px: of the picture
 * for each of the tone, 1 or 2. rgb: width * height * 3, sRGB.
 */
void fl_tone_picture(const uint8_t *tone, FlRect rect, int px, const uint8_t paper[3], int width,
                     int height, uint8_t *rgb);
