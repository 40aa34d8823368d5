/* Four pixels at a time. */
#include "synth/kernels.h"

#include <immintrin.h>

static inline __m128i load_one(const FlPacked *p)
{
    return _mm_load_si128((const __m128i *)p);
}

static inline __m512i four_terms(const FlPacked *centre, const int32_t *offsets,
                                 const FlPacked *target, const FlPacked *weight)
{
    __m512i s = _mm512_castsi128_si512(load_one(centre + offsets[0]));
    s = _mm512_inserti32x4(s, load_one(centre + offsets[1]), 1);
    s = _mm512_inserti32x4(s, load_one(centre + offsets[2]), 2);
    s = _mm512_inserti32x4(s, load_one(centre + offsets[3]), 3);
    const __m512i d = _mm512_sub_epi16(s, _mm512_loadu_si512(target));
    return _mm512_madd_epi16(d, _mm512_mulhrs_epi16(d, _mm512_loadu_si512(weight)));
}

static inline uint32_t sum_of(__m512i v)
{
    return (uint32_t)_mm512_reduce_add_epi32(v);
}

uint32_t fl_patch_distance_avx512(const FlPacked *centre, const int32_t *offsets,
                                  const FlPacked *target, const FlPacked *weight, uint32_t limit)
{
    __m512i sum = four_terms(centre, offsets, target, weight);
    sum = _mm512_add_epi32(sum, four_terms(centre, offsets + 4, target + 4, weight + 4));
    const uint32_t first = sum_of(sum);
    if (first > limit)
        return first;
    sum = _mm512_setzero_si512();
    for (int p = 8; p < 24; p += 4)
        sum = _mm512_add_epi32(sum, four_terms(centre, offsets + p, target + p, weight + p));
    const __m128i d = _mm_sub_epi16(load_one(centre + offsets[24]), load_one(target + 24));
    const __m128i last = _mm_madd_epi16(d, _mm_mulhrs_epi16(d, load_one(weight + 24)));
    return first + sum_of(_mm512_add_epi32(sum, _mm512_zextsi128_si512(last)));
}
