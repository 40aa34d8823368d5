/* Random numbers as a function of place, never of time: the same bytes on any thread count. */
#pragma once

#include <stdint.h>

/** A well-mixed 64-bit hash (the finaliser of SplitMix64). */
static inline uint64_t fl_hash64(uint64_t x)
{
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/** A mixed 32-bit hash for kernels of many lanes (Wellons' lowbias32). */
static inline uint32_t fl_hash32(uint32_t x)
{
    x = (x ^ (x >> 16)) * 0x7feb352du;
    x = (x ^ (x >> 15)) * 0x846ca68bu;
    return x ^ (x >> 16);
}

#define FL_HASH32_STEP 0x9e3779b9u // from one lane's argument to the next

/** A key for a nested place, such as (seed, frame), then level, then pass. */
static inline uint64_t fl_key(uint64_t key, uint64_t place)
{
    return fl_hash64(key ^ fl_hash64(place));
}

/** A stream that starts at key; every call of the functions below advances the stream. */
typedef struct FlRng {
    uint64_t state;
} FlRng;

static inline uint32_t fl_rng_u32(FlRng *rng)
{
    rng->state += 0x9e3779b97f4a7c15u;
    return (uint32_t)(fl_hash64(rng->state) >> 32);
}

/** Uniform in 0 … n - 1; n >= 1. */
static inline uint32_t fl_rng_below(FlRng *rng, uint32_t n)
{
    return (uint32_t)(((uint64_t)fl_rng_u32(rng) * n) >> 32);
}

/** Uniform in [0, 1), 24 bits. */
static inline float fl_rng_float(FlRng *rng)
{
    return (float)(fl_rng_u32(rng) >> 8) * 0x1p-24f;
}
