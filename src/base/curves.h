/* Curves from sums, products and quotients alone: the same bits on every processor. */
#pragma once

#include <glib.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

static inline float fl_clamp(float x, float low, float high)
{
    const float least = x > low ? x : low;
    return least < high ? least : high;
}

/** A smooth step from 0 to 1. */
static inline float fl_smooth(float x)
{
    const float t = fl_clamp(x, 0, 1);
    return t * t * (3 - 2 * t);
}

/** A smooth step: 0 up to `low`, 1 from `high` on, which is larger. */
static inline float fl_smooth_between(float low, float high, float x)
{
    return fl_smooth((x - low) / (high - low));
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

/** The bits of a float. */
static inline int32_t fl_bits(float x)
{
    int32_t bits;
    memcpy(&bits, &x, sizeof bits);
    return bits;
}

/** The float of some bits. */
static inline float fl_of_bits(int32_t bits)
{
    float x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/** exp(-x) to 1e-4 of its value for x >= 0; below 1e-9 it stays so. */
static inline float fl_fall(float x)
{
    // bits of numbers from 0 on are in the order of the numbers, and their minimum has no branch
    const float octaves = fl_of_bits(MIN(fl_bits(x * 1.44269504f), fl_bits(30)));
    const int whole = (int)octaves;
    const float t = (octaves - (float)whole) * 0.693147181f;
    const float power = fl_of_bits((127 - whole) << 23); // 2 to the power of -whole
    return power * (1 - t * (1 - t * (0.5f - t * (0.166667f - t * (0.0416667f - t * 0.0083333f)))));
}

/** exp(-x²). */
static inline float fl_bell(float x)
{
    return fl_fall(x * x);
}

/** The weights of four neighbours, for a place that is t of the way from the second to the third:
 * Catmull and Rom's, exact at neighbours [Keys81]. */
static inline void fl_cubic_weights(float t, float weight[4])
{
    weight[0] = ((-.5f * t + 1) * t - .5f) * t;
    weight[1] = (1.5f * t - 2.5f) * t * t + 1;
    weight[2] = ((-1.5f * t + 2) * t + .5f) * t;
    weight[3] = (.5f * t - .5f) * t * t;
}

/** A plane between its values, by them; its rim goes on outside. 0, 0 is the first value. */
static inline float fl_cubic_sample(const float *plane, int width, int height, float x, float y)
{
    const float fx = floorf(x), fy = floorf(y);
    float across[4], down[4], sum = 0;
    fl_cubic_weights(x - fx, across);
    fl_cubic_weights(y - fy, down);
    for (int j = 0; j < 4; j++)
        for (int i = 0; i < 4; i++)
            sum += down[j] * across[i] *
                   plane[(size_t)CLAMP((int)fy - 1 + j, 0, height - 1) * (size_t)width +
                         (size_t)CLAMP((int)fx - 1 + i, 0, width - 1)];
    return sum;
}

/** A normal variable as a uniform one, 0..1. */
static inline float fl_even(float normal)
{
    const float fall = fl_fall(1.7f * (normal < 0 ? -normal : normal));
    return (normal < 0 ? fall : 1) / (1 + fall);
}
