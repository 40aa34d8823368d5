/* A style and a target small enough to look at every patch: 64x48x6 painted onto 48x48. */
#ifndef TESTS_SMALL_STYLE_H
#define TESTS_SMALL_STYLE_H

#include "base/rng.h"
#include "style/style_folder.h"
#include <math.h>
#include <string.h>

#define STYLE_W 64
#define STYLE_H 48
#define STYLE_FRAMES 6
#define TARGET_SIDE 48

/* Paint of blotches about 4 px wide, in 0 … 1. */
static inline double small_blotches(double x, double y)
{
    const int cx = (int)x / 4, cy = (int)y / 4;
    const double u = x / 4 - cx, v = y / 4 - cy;
    double corner[4];
    for (int k = 0; k < 4; k++)
        corner[k] =
            (double)(fl_hash64((uint64_t)(cy + k / 2) * 64 + (uint64_t)(cx + k % 2)) % 1000) / 999;
    return (corner[0] * (1 - u) + corner[1] * u) * (1 - v) +
           (corner[2] * (1 - u) + corner[3] * u) * v;
}

/* A disc of blotchy paint with a dark rim, which grows by a pixel a frame. */
static inline FlStyle *small_style(void)
{
    FlStyle *style = g_new0(FlStyle, 1);
    *style = (FlStyle){.name = g_strdup("disc"),
                       .path = g_strdup("disc"),
                       .width = STYLE_W,
                       .height = STYLE_H,
                       .n_frames = STYLE_FRAMES,
                       .fps = 25,
                       .border_px = 6,
                       .scale = 1,
                       .paper = {250, 250, 250}};
    const int pixels = STYLE_W * STYLE_H * STYLE_FRAMES;
    style->rgb = g_malloc(3 * (size_t)pixels);
    style->mask = g_malloc((size_t)pixels);
    for (int p = 0; p < pixels; p++) {
        const int t = p / (STYLE_W * STYLE_H), y = p / STYLE_W % STYLE_H, x = p % STYLE_W;
        const double inside = 12 + t - hypot(x - STYLE_W / 2, y - STYLE_H / 2);
        const double tone = 80 + 100 * small_blotches(x, y) - (inside < 3 ? 50 : 0);
        style->mask[p] = (uint8_t)(CLAMP(inside + 0.5, 0, 1) * 255);
        style->rgb[3 * p] = inside > 0 ? (uint8_t)tone : 250;
        style->rgb[3 * p + 1] = inside > 0 ? (uint8_t)(tone * 0.7 + 30) : 250;
        style->rgb[3 * p + 2] = inside > 0 ? (uint8_t)(tone * 0.4 + 60) : 250;
    }
    return style;
}

/* An FlGuideSource's masks: a disc that moves to the right by a pixel a frame. */
static inline bool small_moving_disc(void *data, int frame, uint8_t *coverage, GError **error)
{
    for (int p = 0; p < TARGET_SIDE * TARGET_SIDE; p++) {
        const double inside = 14 - hypot(p % TARGET_SIDE - 22 - frame, p / TARGET_SIDE - 24);
        coverage[p] = (uint8_t)(CLAMP(inside + 0.5, 0, 1) * 255);
    }
    return true;
}

#endif
