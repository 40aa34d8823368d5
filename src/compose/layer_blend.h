/* Blending: the 16-bit values in which layers are blended, and paint lifted off its paper. */
#pragma once

#include <stdbool.h>
#include <stdint.h>

/** 8-bit sRGB levels as blending values 0..65535: level * 257, or linear light. */
typedef struct FlTransfer {
    int32_t value[256];
    bool linear;
} FlTransfer;

void fl_transfer_init(FlTransfer *scale, bool linear);

/** The nearest 8-bit level of a value; values out of range are clamped. */
uint8_t fl_transfer_level(const FlTransfer *scale, int64_t value);

/** The 16-bit sRGB level of a value 0..65535. */
uint16_t fl_transfer_level16(const FlTransfer *scale, int32_t value);

/** The least alpha 0..255 with which something over `paper` can have the colour. */
int fl_least_alpha(const FlTransfer *scale, const uint8_t colour[3], const uint8_t paper[3]);

/**
 * The most transparent straight RGBA of alpha >= opacity which over `paper` gives `colour`, to
 * within a level. With alpha 0 the colour is kept, so that nothing pale bleeds in when scaled.
 */
void fl_unblend(const FlTransfer *scale, const uint8_t colour[3], const uint8_t paper[3],
                int opacity, uint8_t rgba[4]);
