/* Sets of small numbers, a bit each. */
#pragma once

#include "base/alloc.h"
#include <stdbool.h>

/** An empty set of numbers below n; as fl_alloc(). */
static inline uint64_t *fl_bits_new(size_t n, const char *what, GError **error)
{
    return fl_alloc(n / 64 + 1, sizeof(uint64_t), what, error);
}

static inline bool fl_bit(const uint64_t *bits, size_t k)
{
    return bits[k / 64] >> (k % 64) & 1;
}

static inline void fl_bit_set(uint64_t *bits, size_t k)
{
    bits[k / 64] |= (uint64_t)1 << (k % 64);
}

static inline void fl_bit_clear(uint64_t *bits, size_t k)
{
    bits[k / 64] &= ~((uint64_t)1 << (k % 64));
}
