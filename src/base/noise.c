#include "base/noise.h"

#include "base/rng.h"

#include <math.h>

static float slope(uint64_t key, int32_t ix, int32_t iy, float dx, float dy)
{
    const uint64_t bits = fl_key(key, (uint64_t)(uint32_t)ix << 32 | (uint32_t)iy);
    const float gx = (float)(int16_t)(bits >> 48) * 0x1p-15f;
    const float gy = (float)(int16_t)(bits >> 32) * 0x1p-15f;
    return gx * dx + gy * dy;
}

static float ease(float t)
{
    return t * t * t * (t * (t * 6 - 15) + 10);
}

static float mix(float a, float b, float t)
{
    return a + (b - a) * t;
}

float fl_noise(uint64_t key, float x, float y)
{
    const float fx = floorf(x), fy = floorf(y);
    const int32_t ix = (int32_t)fx, iy = (int32_t)fy;
    const float dx = x - fx, dy = y - fy, tx = ease(dx);
    const float upper = mix(slope(key, ix, iy, dx, dy), slope(key, ix + 1, iy, dx - 1, dy), tx);
    const float lower =
        mix(slope(key, ix, iy + 1, dx, dy - 1), slope(key, ix + 1, iy + 1, dx - 1, dy - 1), tx);
    return 2.0f * mix(upper, lower, ease(dy)); // the standard deviation is then about 0.5
}

float fl_noise_octaves(uint64_t key, float x, float y, int octaves, float gain)
{
    float sum = 0, weight = 1, squares = 0;
    for (int o = 0; o < octaves; o++) {
        sum += weight * fl_noise(fl_key(key, (uint64_t)o), x, y);
        squares += weight * weight;
        weight *= gain;
        x *= 2, y *= 2;
    }
    return sum / sqrtf(squares);
}
