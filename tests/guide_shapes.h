/* Drawn masks for the tests of the guides: antialiased by 16x16 samples a pixel. */
#ifndef FLUIDY_TESTS_GUIDE_SHAPES_H
#define FLUIDY_TESTS_GUIDE_SHAPES_H

#include <stdbool.h>
#include <stdint.h>

enum { SHAPE_SAMPLES = 16 };

/** Adds a disc to a mask; x, y and radius in px, pixel centres at integers. */
static inline void draw_disc(uint8_t *mask, int width, int height, float x, float y, float radius)
{
    for (int py = 0; py < height; py++)
        for (int px = 0; px < width; px++) {
            const float dx = (float)px - x, dy = (float)py - y;
            int n = 0;
            if (dx * dx + dy * dy > (radius + 1) * (radius + 1))
                continue;
            for (int k = 0; k < SHAPE_SAMPLES * SHAPE_SAMPLES; k++) {
                const int column = k % SHAPE_SAMPLES, row = k / SHAPE_SAMPLES;
                const float sx = dx + ((float)column + 0.5f) / SHAPE_SAMPLES - 0.5f;
                const float sy = dy + ((float)row + 0.5f) / SHAPE_SAMPLES - 0.5f;
                n += sx * sx + sy * sy < radius * radius;
            }
            const int coverage = (n * 255 + 128) / (SHAPE_SAMPLES * SHAPE_SAMPLES);
            if (coverage > mask[py * width + px])
                mask[py * width + px] = (uint8_t)coverage;
        }
}

/** Adds full pixels. */
static inline void draw_box(uint8_t *mask, int width, int x, int y, int box_width, int box_height)
{
    for (int py = y; py < y + box_height; py++)
        for (int px = x; px < x + box_width; px++)
            mask[py * width + px] = 255;
}

#endif
