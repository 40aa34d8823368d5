/* Curves from sums, products and quotients alone: the same bits on every processor. */
#ifndef FLUIDY_BASE_CURVES_H
#define FLUIDY_BASE_CURVES_H

#include <glib.h>
#include <stdint.h>
#include <string.h>

static inline float fl_clamp(float x, float low, float high)
{
    return x > low ? (x < high ? x : high) : low;
}

/** A smooth step from 0 to 1. */
static inline float fl_smooth(float x)
{
    const float t = fl_clamp(x, 0, 1);
    return t * t * (3 - 2 * t);
}

/** A smooth step: 0 up to `from`, 1 from `to` on. */
static inline float fl_ease(float from, float to, float x)
{
    return fl_smooth((x - from) / (to - from + 1e-6f));
}

/** Nearly exp(-x) for x >= 0, and faster than fl_fall(): in the end it falls as 1 / x³. */
static inline float fl_decay(float x)
{
    return 1 / (1 + x * (1 + x * (.5f + x * .16f)));
}

/** exp(-x) to 1e-4 of its value for x >= 0; below 1e-9 it stays so. */
static inline float fl_fall(float x)
{
    const float octaves = MIN(x * 1.44269504f, 30);
    const int whole = (int)octaves;
    const float t = (octaves - (float)whole) * 0.693147181f;
    const uint32_t bits = (uint32_t)(127 - whole) << 23; // 2 to the power of -whole
    float power;
    memcpy(&power, &bits, sizeof power);
    return power * (1 - t * (1 - t * (0.5f - t * (0.166667f - t * (0.0416667f - t * 0.0083333f)))));
}

/** exp(-x²). */
static inline float fl_bell(float x)
{
    return fl_fall(x * x);
}

/** A normal variable as a uniform one, 0..1. */
static inline float fl_even(float normal)
{
    const float fall = fl_fall(1.7f * (normal < 0 ? -normal : normal));
    return (normal < 0 ? fall : 1) / (1 + fall);
}

#endif
