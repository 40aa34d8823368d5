/* The uppermost paint of a frame, which may stain the paper in later frames. */
#pragma once

#include "compose/layers.h"
#include "worker/draws.h"

/** The uppermost painted layer of each cell of a grid over the frame. */
typedef struct FlLaid {
    int width, height; // cells
    float cell_px;     // px of the frame per cell
    uint8_t *rgb;      // width * height * 3: its paint over bare paper
    int16_t *region;   // width * height: the region whose paint it is; -1: no paint
} FlLaid;

bool fl_laid_init(FlLaid *laid, int width, int height, float cell_px, GError **error);
void fl_laid_clear(FlLaid *laid);

/** Forgets the frame before. */
void fl_laid_begin(FlLaid *laid);

/** Lays a layer, bottom first, that has been packed. */
void fl_laid_add(FlLaid *laid, const FlLayer *layer, int region, const uint8_t paper[3]);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlLaid, fl_laid_clear)
