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

/* A row of four pixels as pairs of one channel, times the pairs of weights. */
static inline __m256i row_sums(const FlSplinePixel *row, __m256i x)
{
    const __m256i pairs = _mm256_setr_epi8(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15, //
                                           0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15);
    return _mm256_madd_epi16(_mm256_shuffle_epi8(_mm256_loadu_si256((const __m256i *)row), pairs),
                             x);
}

void fl_spline_sample_avx2(const FlSplinePixel *first, size_t pitch, const int16_t *x,
                           const float *y, float value[4])
{
    const __m256i wx = _mm256_load_si256((const __m256i *)x);
    __m128 sum = _mm_setzero_ps();
    for (int j = 0; j < 4; j++) {
        const __m256i halves = row_sums(first + j * pitch, wx);
        const __m128i row =
            _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
        sum = _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(y[j]), _mm_cvtepi32_ps(row)));
    }
    _mm_storeu_ps(value, sum);
}

/* Sixteen votes and what is left of them, lanes of all ones. */
typedef struct Half {
    __m256i x, y, frame, left;
} Half;

static inline Half load_half(const FlVotes *votes, int at)
{
    Half h;
    h.x = _mm256_load_si256((const __m256i *)(votes->x + at));
    h.y = _mm256_load_si256((const __m256i *)(votes->y + at));
    h.frame = _mm256_load_si256((const __m256i *)(votes->frame + at));
    h.left = _mm256_cmpgt_epi16(h.frame, _mm256_set1_epi16(-1));
    return h;
}

/* A bit for each byte of both halves' lanes. */
static inline uint64_t bits_of(__m256i low, __m256i high)
{
    return (uint32_t)_mm256_movemask_epi8(low) | (uint64_t)(uint32_t)_mm256_movemask_epi8(high)
                                                     << 32;
}

/* Takes the lanes near the leader out of `left`; adds their differences to (x, y) pairs. */
static inline __m256i take(Half *h, __m256i x, __m256i y, __m256i frame, __m256i *sums)
{
    const __m256i limit = _mm256_set1_epi16(FL_SAME_PLACE), ones = _mm256_set1_epi16(1);
    const __m256i dx = _mm256_sub_epi16(h->x, x), dy = _mm256_sub_epi16(h->y, y);
    __m256i same = _mm256_and_si256(h->left, _mm256_cmpeq_epi16(h->frame, frame));
    same = _mm256_and_si256(same, _mm256_cmpgt_epi16(limit, _mm256_abs_epi16(dx)));
    same = _mm256_and_si256(same, _mm256_cmpgt_epi16(limit, _mm256_abs_epi16(dy)));
    h->left = _mm256_andnot_si256(same, h->left);
    const __m256i sx = _mm256_madd_epi16(_mm256_and_si256(dx, same), ones);
    const __m256i sy = _mm256_madd_epi16(_mm256_and_si256(dy, same), ones);
    *sums = _mm256_add_epi32(*sums, _mm256_hadd_epi32(sx, sy));
    return same;
}

int fl_find_opinions_avx2(const FlVotes *votes, FlOpinion *opinions)
{
    Half low = load_half(votes, 0), high = load_half(votes, 16);
    const __m256i first_nine = // of 25 votes
        _mm256_setr_epi16(-1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0);
    high.left = _mm256_and_si256(high.left, first_nine);
    int n = 0;
    uint64_t left;
    while ((left = bits_of(low.left, high.left)) != 0) {
        const int leader = __builtin_ctzll(left) / 2;
        const __m256i x = _mm256_set1_epi16((int16_t)votes->x[leader]);
        const __m256i y = _mm256_set1_epi16((int16_t)votes->y[leader]);
        const __m256i frame = _mm256_set1_epi16(votes->frame[leader]);
        __m256i sums = _mm256_setzero_si256(); // x x y y, in both halves
        const __m256i a = take(&low, x, y, frame, &sums), b = take(&high, x, y, frame, &sums);
        __m128i s = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
        s = _mm_hadd_epi32(s, s);
        opinions[n++] = (FlOpinion){
            votes->x[leader],     votes->y[leader],        votes->frame[leader],
            _mm_cvtsi128_si32(s), _mm_extract_epi32(s, 1), __builtin_popcountll(bits_of(a, b)) / 2};
    }
    return n;
}
