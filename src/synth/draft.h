/* Drafts are painted at half the size: masks and flow on the way in, pictures on the way out. */
#ifndef FLUIDY_SYNTH_DRAFT_H
#define FLUIDY_SYNTH_DRAFT_H

#include "guides/guides.h"

/** A side of a draft of a frame with a side of `px` pixels; halves count as whole pixels. */
static inline int fl_half_side(int px)
{
    return (px + 1) / 2;
}

/** The coverage of width * height pixels at half the size. */
void fl_mask_halve(const uint8_t *mask, int width, int height, uint8_t *half);

/** The flow, interleaved, at half the size; lengths become those of the small frame. */
void fl_flow_halve(const float *flow, int width, int height, float *half);

/** Enlarges the guides of a draft in place, for those who look at them; they were made for at least
 * width * height pixels. */
void fl_guides_double(FlGuides *guides, int width, int height);

/** Enlarges a picture of (width + 1) / 2 by (height + 1) / 2 pixels, 3 bytes each, bilinearly. */
void fl_picture_double(const uint8_t *half, int width, int height, uint8_t *rgb);

#endif
