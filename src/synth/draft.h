/* Drafts are painted at half the size: guides on the way in, pictures on the way out. */
#ifndef FLUIDY_SYNTH_DRAFT_H
#define FLUIDY_SYNTH_DRAFT_H

#include "guides/guides.h"

/** The frame at half the size, rounded up; lengths become those of the small frame. `half` is made
 * for that size. */
void fl_guides_halve(const FlGuides *guides, FlGuides *half);

/** Enlarges a picture of (width + 1) / 2 by (height + 1) / 2 pixels, 3 bytes each, bilinearly. */
void fl_picture_double(const uint8_t *half, int width, int height, uint8_t *rgb);

#endif
