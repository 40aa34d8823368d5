/* Estimates from the frames of a recording: the paper's colour and the masks. */
#pragma once

#include "base/picture.h"
#include "style/style_folder.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/**
 * The colour of the bare paper.
 *
 * With masks (coverage, n_frames * height * width) it is the median of the pixels outside them;
 * without (NULL), the commonest colour along the rim of the first frame, which has the least paint.
 * White if the masks leave less than a thousandth of the clip bare.
 */
void fl_paper_estimate(const FlClip *clip, const uint8_t *mask, uint8_t paper[3]);

/**
 * Finds the paint: the difference from the paper, smoothed and thresholded, its largest connected
 * parts with their pinholes closed, smoothed again and cut below one half, so that a thin margin of
 * bare paper belongs to the mask [P21 §4.1.1]. Writes antialiased coverage, n_frames * height *
 * width.
 *
 * A frame without paint gets an empty mask. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_extract_masks(const FlClip *clip, const uint8_t paper[3], uint8_t *mask, GError **error);

/**
 * The behaviour of paint on paper, from its rim and grain: soft and light rims are wet, grain is
 * dry. The first quarter of the frames is taken for fresh paint, the last for dry; one picture is
 * both. The defaults where no paint is 16 px deep. FL_ERROR_NO_MEMORY.
 */
bool fl_front_estimate(const FlStyle *style, FlFrontStyle *front, GError **error);

/** The unevenness that a recording has of its own, and the wash that goes with it. */
typedef struct FlWashEstimate {
    float kurtosis; // of the paint's lightness: 3 for noise, 6 and more for a few marks in quiet
                    // places, as scanned washes have; 0: no paint is deep enough
    float hue;      // wander of its colour, CIE76
    FlWashStyle wash;
} FlWashEstimate;

/**
 * Looks at the last frame. Noise of wet paint has to be calmed, marks must stay, and paint whose
 * hue wanders is painted with one that does, since a tint loses the recording's. wet: width of its
 * fronts. The defaults where less than an eighth of the frame is 16 px deep in paint.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_wash_estimate(const FlStyle *style, float wet, FlWashEstimate *found, GError **error);

/** The mean coverage of a mask, 0..1. */
double fl_mask_share(const uint8_t *mask, int width, int height);

/**
 * fl_blur() in the variant for importing recordings: it is rounded differently, and its radius of
 * three sigma is rounded up to a pixel. sigma_px > 0.
 */
bool fl_blur_recording(float *plane, int width, int height, float sigma_px, GError **error);

/* ---- border ---------------------------------------------------------------------------------- */

/**
 * The border width b [F21 §3.1], in px: the depth below the outline from which on the mean colour
 * of all pixels of that depth keeps within a sixth of its whole change. From 3 px to a sixth of the
 * frame's shorter side; masks without any outline give the latter.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_border_estimate(const FlClip *clip, const uint8_t *mask, float *border_px, GError **error);

/* ---- light ----------------------------------------------------------------------------------- */

/** The first bin of a histogram up to which half of what it counts lies; 0: it counts nothing. */
static inline int fl_median_bin(const uint32_t *count, int bins)
{
    uint64_t n = 0, sum = 0;
    int bin = 0;
    for (int k = 0; k < bins; k++)
        n += count[k];
    while (2 * (sum += count[bin]) < n)
        bin++;
    return bin;
}

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
