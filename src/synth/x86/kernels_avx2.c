/* Two pixels at a time. */
#include "synth/kernels.h"

#include <immintrin.h>

/* Two exemplar pixels, widened to the target's steps. */
static inline __m256i load_two(const FlTexel *a, const FlTexel *b)
{
    const __m128d first = _mm_load_sd((const double *)a);
    const __m128i both = _mm_castpd_si128(_mm_loadh_pd(first, (const double *)b));
    return _mm256_slli_epi16(_mm256_cvtepu8_epi16(both), 4);
}

static inline __m256i two_terms(const FlTexel *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight)
{
    const __m256i s = load_two(centre + offsets[0], centre + offsets[1]);
    const __m256i d = _mm256_sub_epi16(s, _mm256_load_si256((const __m256i *)target));
    const __m256i w = _mm256_load_si256((const __m256i *)weight);
    return _mm256_madd_epi16(d, _mm256_mulhrs_epi16(d, w));
}

static inline uint32_t sum_of(__m256i v)
{
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1));
    return (uint32_t)_mm_cvtsi128_si32(s);
}

uint32_t fl_patch_distance_avx2(const FlTexel *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit)
{
    __m256i sum = _mm256_setzero_si256();
    for (int p = 0; p < 8; p += 2)
        sum = _mm256_add_epi32(sum, two_terms(centre, offsets + p, target + p, weight + p));
    if (sum_of(sum) > limit)
        return sum_of(sum);
    for (int p = 8; p < 16; p += 2)
        sum = _mm256_add_epi32(sum, two_terms(centre, offsets + p, target + p, weight + p));
    if (sum_of(sum) > limit)
        return sum_of(sum);
    for (int p = 16; p < 24; p += 2)
        sum = _mm256_add_epi32(sum, two_terms(centre, offsets + p, target + p, weight + p));
    const __m128i texel = _mm_loadl_epi64((const __m128i *)(centre + offsets[24]));
    const __m128i s = _mm_slli_epi16(_mm_cvtepu8_epi16(texel), 4);
    const __m128i d = _mm_sub_epi16(s, _mm_load_si128((const __m128i *)(target + 24)));
    const __m128i last =
        _mm_madd_epi16(d, _mm_mulhrs_epi16(d, _mm_load_si128((const __m128i *)(weight + 24))));
    return sum_of(_mm256_add_epi32(sum, _mm256_zextsi128_si256(last)));
}
