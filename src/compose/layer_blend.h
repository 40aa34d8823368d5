/* Blending: the 16-bit values in which layers are mixed, and paint lifted off its paper. */
#ifndef FLUIDY_COMPOSE_LAYER_BLEND_H
#define FLUIDY_COMPOSE_LAYER_BLEND_H

#include <stdbool.h>
#include <stdint.h>

/** 8-bit sRGB levels as blending values 0..65535: level * 257, or linear light. */
typedef struct FlScale {
    int32_t value[256];
    bool linear;
} FlScale;

void fl_scale_init(FlScale *scale, bool linear);

/** The nearest 8-bit level of a value; values out of range are clamped. */
uint8_t fl_scale_level(const FlScale *scale, int64_t value);

/** The 16-bit sRGB level of a value 0..65535. */
uint16_t fl_scale_level16(const FlScale *scale, int32_t value);

/** The least alpha 0..255 with which something over `paper` can have the colour. */
int fl_least_alpha(const FlScale *scale, const uint8_t colour[3], const uint8_t paper[3]);

/**
 * The most transparent straight RGBA of alpha >= opacity which over `paper` gives `colour`, to
 * within a level. With alpha 0 the colour is kept, so that nothing pale bleeds in when scaled.
 */
void fl_lift(const FlScale *scale, const uint8_t colour[3], const uint8_t paper[3], int opacity,
             uint8_t rgba[4]);

#endif
