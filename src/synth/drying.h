/* Paint is wet where it is new or moves, and dries: the exemplar shows it fresh and dry. */
#ifndef FLUIDY_SYNTH_DRYING_H
#define FLUIDY_SYNTH_DRYING_H

#include "synth/carry.h"

/** How paint dries in a frame. */
typedef struct FlDrying {
    const FlGuides *guides; // of the frame
    float unit_px;          // 1/480 of the page's larger side
    int width;              // of the frame
    float wets;             // of the exemplar
} FlDrying;

#define FL_TONE_ONE 128

/** How wet a pixel of guides is where nothing moves. */
int fl_wet_at_rest(const FlGuides *guides, size_t pixel, float unit_px);

/**
 * The wetness of all pixels of a rectangle, which come from the frame before as `carried` has them;
 * NULL: nothing was before, and paint is as wet as it would be had it moved so for long.
 *
 * Inside, paint is wetter the faster it moves; near the contour it is fresh where that advances and
 * dry where it recedes. It gets wet within two frames, dries within 36, and starts fresh where it
 * is new. wet: of the frame, 0 elsewhere. tone: of rect, by which its density is multiplied,
 * FL_TONE_ONE is 1: what is fresh is pale, and pigment gathers where the contour recedes.
 *
 * Returns: whether any is not as wet as it is at rest.
 */
bool fl_drying_step(const FlDrying *drying, FlRect rect, const FlCarried *carried, uint8_t *wet,
                    uint8_t *tone);

/**
 * Moves carried matches on, or back, by the frames of the exemplar between what they were and
 * `wet`, in their place; beside a rim, which moves there, at their depth. They stop where there is
 * no paint of their segment.
 */
void fl_drying_show(const FlDrying *drying, FlRect rect, const uint8_t *wet,
                    const FlExemplar *exemplar, FlCarried *carried);

/**
 * Multiplies the density of a picture's paint, on its paper, by a tone of rect; px: of the picture
 * for each of the tone, 1 or 2. rgb: width * height * 3, sRGB.
 */
void fl_tone_picture(const uint8_t *tone, FlRect rect, int px, const uint8_t paper[3], int width,
                     int height, uint8_t *rgb);

#endif
