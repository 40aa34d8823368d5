/* Four pixels at a time. */
#include "synth/kernels.h"

#include <immintrin.h>

static inline __m128i load_two(const FlTexel *a, const FlTexel *b)
{
    const __m128d first = _mm_load_sd((const double *)a);
    return _mm_castpd_si128(_mm_loadh_pd(first, (const double *)b));
}

static inline __m512i four_terms(const FlTexel *centre, const int32_t *offsets,
                                 const FlPacked *target, const FlPacked *weight)
{
    const __m128i low = load_two(centre + offsets[0], centre + offsets[1]);
    const __m128i high = load_two(centre + offsets[2], centre + offsets[3]);
    const __m256i texels = _mm256_inserti128_si256(_mm256_castsi128_si256(low), high, 1);
    const __m512i s = _mm512_slli_epi16(_mm512_cvtepu8_epi16(texels), 4);
    const __m512i d = _mm512_sub_epi16(s, _mm512_load_si512(target));
    return _mm512_madd_epi16(d, _mm512_mulhrs_epi16(d, _mm512_load_si512(weight)));
}

static inline uint32_t sum_of(__m512i v)
{
    return (uint32_t)_mm512_reduce_add_epi32(v);
}

uint32_t fl_patch_distance_avx512(const FlTexel *centre, const int32_t *offsets,
                                  const FlPacked *target, const FlPacked *weight, uint32_t limit)
{
    __m512i sum = four_terms(centre, offsets, target, weight);
    sum = _mm512_add_epi32(sum, four_terms(centre, offsets + 4, target + 4, weight + 4));
    const uint32_t first = sum_of(sum);
    if (first > limit)
        return first;
    for (int p = 8; p < 24; p += 4)
        sum = _mm512_add_epi32(sum, four_terms(centre, offsets + p, target + p, weight + p));
    const __m128i texel = _mm_loadl_epi64((const __m128i *)(centre + offsets[24]));
    const __m128i s = _mm_slli_epi16(_mm_cvtepu8_epi16(texel), 4);
    const __m128i d = _mm_sub_epi16(s, _mm_load_si128((const __m128i *)(target + 24)));
    const __m128i last =
        _mm_madd_epi16(d, _mm_mulhrs_epi16(d, _mm_load_si128((const __m128i *)(weight + 24))));
    return sum_of(_mm512_add_epi32(sum, _mm512_zextsi128_si512(last)));
}

/* The sum of the lanes of a mask. */
static inline int masked_sum(__m512i v, __mmask32 mask)
{
    const __m512i pairs = _mm512_madd_epi16(_mm512_maskz_mov_epi16(mask, v), _mm512_set1_epi16(1));
    return _mm512_reduce_add_epi32(pairs);
}

static inline __mmask32 near_zero(__m512i difference)
{
    return _mm512_cmplt_epi16_mask(_mm512_abs_epi16(difference), _mm512_set1_epi16(FL_SAME_PLACE));
}

int fl_find_opinions_avx512(const FlVotes *votes, FlOpinion *opinions)
{
    const __m512i x = _mm512_load_si512(votes->x), y = _mm512_load_si512(votes->y);
    const __m512i frame = _mm512_load_si512(votes->frame);
    __mmask32 left = _mm512_cmpge_epi16_mask(frame, _mm512_setzero_si512());
    left &= (1u << FL_PATCH_PIXELS) - 1;
    int n = 0;
    while (left) {
        const int k = __builtin_ctz(left);
        const __m512i dx = _mm512_sub_epi16(x, _mm512_set1_epi16((int16_t)votes->x[k]));
        const __m512i dy = _mm512_sub_epi16(y, _mm512_set1_epi16((int16_t)votes->y[k]));
        const __mmask32 same = left & near_zero(dx) & near_zero(dy) &
                               _mm512_cmpeq_epi16_mask(frame, _mm512_set1_epi16(votes->frame[k]));
        left &= ~same;
        opinions[n++] =
            (FlOpinion){votes->x[k],          votes->y[k],          votes->frame[k],
                        masked_sum(dx, same), masked_sum(dy, same), __builtin_popcount(same)};
    }
    return n;
}
