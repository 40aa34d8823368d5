/* The bare paper under uneven light: what each pixel would show if there were no paint. */
#ifndef FLUIDY_STYLE_FLAT_FIELD_H
#define FLUIDY_STYLE_FLAT_FIELD_H

#include "base/picture.h"

/** Light that falls off smoothly: a polynomial of degree two over the frame for each channel. */
typedef struct FlFlatField {
    int width, height;
    uint8_t paper[3];  // the paper where the gain is 1
    double gain[3][6]; // of 1, u, v, u², uv, v²; u and v run from -1 to 1 over the frame
    double low[3],
        high[3]; // the range of gains at bare places, which also limits gains under paint
} FlFlatField;

/**
 * Fits the light to the bare paper: to the pixels outside all masks, or, if mask is NULL, to those
 * that look like `paper`. With too little bare paper it assumes even light.
 */
void fl_flat_field_fit(FlFlatField *field, const FlClip *clip, const uint8_t *mask,
                       const uint8_t paper[3]);

/** The level of bare paper, or of the paper under paint, at a pixel in channel c. */
float fl_flat_field_at(const FlFlatField *field, int x, int y, int c);

/** The difference of the lightest and darkest point of the field, in levels. */
float fl_flat_field_range(const FlFlatField *field);

/**
 * Makes the light even and constant: divides rgb (as the clip's) by the field, and each frame by
 * what is left of its bare paper's median, so that the paper has its colour everywhere.
 */
void fl_flat_field_flatten(const FlFlatField *field, uint8_t *rgb, const uint8_t *mask,
                           int n_frames);

#endif
