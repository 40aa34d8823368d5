/* Two pixels at a time. */
#include "synth/vote_kernel.h"

#include <glib.h>
#include <immintrin.h>

/* Byte orders of two pixels: as they are, with their extents changing places, and changing places
 * themselves besides. */
static const int8_t orders[3][16] = {
    {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15},
    {0, 1, 2, 3, 5, 4, 6, 7, 8, 9, 10, 11, 13, 12, 14, 15},
    {8, 9, 10, 11, 13, 12, 14, 15, 0, 1, 2, 3, 5, 4, 6, 7},
};

static inline __m128i order_of(int k)
{
    return _mm_loadu_si128((const __m128i *)orders[k]);
}

static inline __m128i load_two(const FlTexel *centre, const int16_t *offsets)
{
    const __m128d first = _mm_load_sd((const double *)(centre + offsets[0]));
    return _mm_castpd_si128(_mm_loadh_pd(first, (const double *)(centre + offsets[1])));
}

/* The weights of two pixels: each one's for its colours, the rest for the other channels. */
static inline __m256i weights_of(__m256i target, __m256i rest)
{
    const __m256i colour =
        _mm256_setr_epi8(12, 13, 12, 13, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1, 12, 13, 12,
                         13, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
    return _mm256_or_si256(_mm256_shuffle_epi8(target, colour), rest);
}

/* The weights of the other channels, where those of the colours are 0. */
static inline __m256i load_rest(const FlTargetTexel *rest)
{
    const __m128i others = _mm_setr_epi16(0, 0, 0, -1, -1, -1, 0, 0);
    return _mm256_broadcastsi128_si256(
        _mm_and_si128(others, _mm_loadu_si128((const __m128i *)rest)));
}

static inline __m256i two_terms(__m128i texels, __m256i target, __m256i weight)
{
    const __m256i s = _mm256_slli_epi16(_mm256_cvtepu8_epi16(texels), 4); // to the target's steps
    const __m256i d = _mm256_sub_epi16(s, target);
    return _mm256_madd_epi16(d, _mm256_mulhrs_epi16(d, weight));
}

static inline __m256i load_target(const FlTargetTexel *target)
{
    return _mm256_load_si256((const __m256i *)target);
}

/* The last pixel of 25; the upper lanes are 0. */
static inline __m256i load_last(const FlTargetTexel *target)
{
    return _mm256_zextsi128_si256(_mm_load_si128((const __m128i *)(target + 24)));
}

/* Texels beyond the 25th add 0. */
static inline __m256i last_term(__m128i texel, const FlTargetTexel *target, __m256i rest)
{
    const __m256i t = load_last(target);
    const __m256i terms = two_terms(texel, t, weights_of(t, rest));
    return _mm256_zextsi128_si256(_mm256_castsi256_si128(terms));
}

static inline uint32_t sum_of(__m256i v)
{
    __m128i s = _mm_add_epi32(_mm256_castsi256_si128(v), _mm256_extracti128_si256(v, 1));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0x4e));
    s = _mm_add_epi32(s, _mm_shuffle_epi32(s, 0xb1));
    return (uint32_t)_mm_cvtsi128_si32(s);
}

uint32_t fl_patch_distance_avx2(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                const FlTargetTexel *target, const FlTargetTexel *rest,
                                uint32_t limit)
{
    const __m128i order = order_of(opposed);
    const __m256i others = load_rest(rest);
    __m256i sum = _mm256_setzero_si256();
    for (int p = 0; p < 24; p += 2) {
        const __m128i texels = _mm_shuffle_epi8(load_two(centre, offsets + p), order);
        const __m256i t = load_target(target + p);
        sum = _mm256_add_epi32(sum, two_terms(texels, t, weights_of(t, others)));
        if ((p == 6 || p == 14) && sum_of(sum) > limit)
            return sum_of(sum);
    }
    const __m128i texel = _mm_loadl_epi64((const __m128i *)(centre + offsets[24]));
    return sum_of(_mm256_add_epi32(sum, last_term(_mm_shuffle_epi8(texel, order), target, others)));
}

void fl_patch_pair_avx2(const FlTexel *centre, const int16_t *offsets, const FlTargetTexel *target,
                        const FlTargetTexel *rest, uint32_t limit, uint32_t distance[2])
{
    const __m128i turned = order_of(2);
    const __m256i others = load_rest(rest);
    __m256i sum = _mm256_setzero_si256(), turned_sum = sum;
    for (int p = 0; p < 24; p += 2) {
        const __m128i texels = load_two(centre, offsets + p);
        const __m256i t = load_target(target + p), w = weights_of(t, others);
        sum = _mm256_add_epi32(sum, two_terms(texels, t, w));
        turned_sum =
            _mm256_add_epi32(turned_sum, two_terms(_mm_shuffle_epi8(texels, turned), t, w));
        if (p == 6 || p == 14) {
            distance[0] = sum_of(sum), distance[1] = sum_of(turned_sum);
            if (distance[0] > limit && distance[1] > limit)
                return;
        }
    }
    const __m128i texel = _mm_loadl_epi64((const __m128i *)centre);
    const __m128i opposed = _mm_shuffle_epi8(texel, order_of(1));
    distance[0] = sum_of(_mm256_add_epi32(sum, last_term(texel, target, others)));
    distance[1] = sum_of(_mm256_add_epi32(turned_sum, last_term(opposed, target, others)));
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

/* A bit for each lane of both halves. */
static inline uint32_t bits_of(__m256i low, __m256i high)
{
    const __m256i bytes = _mm256_packs_epi16(low, high);
    return (uint32_t)_mm256_movemask_epi8(_mm256_permute4x64_epi64(bytes, _MM_SHUFFLE(3, 1, 2, 0)));
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

static int cluster_votes(const FlVotes *votes, FlVoteCluster *clusters)
{
    Half low = load_half(votes, 0), high = load_half(votes, 16);
    const __m256i first_nine = // of 25 votes
        _mm256_setr_epi16(-1, -1, -1, -1, -1, -1, -1, -1, -1, 0, 0, 0, 0, 0, 0, 0);
    high.left = _mm256_and_si256(high.left, first_nine);
    int n = 0;
    uint32_t left;
    while ((left = bits_of(low.left, high.left)) != 0) {
        const int leader = fl_vote_leader(left);
        const __m256i x = _mm256_set1_epi16((int16_t)votes->x[leader]);
        const __m256i y = _mm256_set1_epi16((int16_t)votes->y[leader]);
        const __m256i frame = _mm256_set1_epi16(votes->frame[leader]);
        __m256i sums = _mm256_setzero_si256(); // x x y y, in both halves
        const __m256i a = take(&low, x, y, frame, &sums), b = take(&high, x, y, frame, &sums);
        __m128i s = _mm_add_epi32(_mm256_castsi256_si128(sums), _mm256_extracti128_si256(sums, 1));
        s = _mm_hadd_epi32(s, s);
        clusters[n++] =
            (FlVoteCluster){votes->x[leader],     votes->y[leader],        votes->frame[leader],
                            _mm_cvtsi128_si32(s), _mm_extract_epi32(s, 1), bits_of(a, b)};
    }
    return n;
}

bool fl_vote_avx2(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4])
{
    return fl_vote_of(covering, cluster_votes, fl_spline_sample_avx2, voted, colour);
}

bool fl_vote_doubled_avx2(const FlVoteMatches *covering, const FlVoteSource *voted,
                          float colour[4][4])
{
    return fl_vote_doubled_of(covering, cluster_votes, fl_spline_sample_avx2, voted, colour);
}

/* The squared differences of a pixel; the past's are weighted first, the others by 32767, which
 * leaves them as they are. */
static inline __m256i fluid_terms(const FlFluidTexel *source, const FlFluidTexel *target)
{
    const __m256i past = _mm256_setr_epi16(0, 0, 0, 0, 0, 0, 0, 0, -1, -1, -1, -1, 0, 0, 0, 0);
    const __m256i rest = _mm256_setr_epi16(INT16_MAX, INT16_MAX, INT16_MAX, INT16_MAX, INT16_MAX, 0,
                                           0, 0, 0, 0, 0, 0, 0, 0, 0, 0);
    const __m256i weight = _mm256_and_si256(_mm256_set1_epi16(target->c[FL_FLUID_WEIGHT]), past);
    const __m256i s = _mm256_load_si256((const __m256i *)source);
    const __m256i t = _mm256_load_si256((const __m256i *)target);
    const __m256i d = _mm256_mulhrs_epi16(_mm256_sub_epi16(s, t), _mm256_or_si256(weight, rest));
    return _mm256_madd_epi16(d, d);
}

uint32_t fl_fluid_distance_avx2(const FlFluidTexel source[FL_PATCH_PIXELS],
                                const FlFluidTexel *target, ptrdiff_t pitch, uint32_t limit)
{
    __m256i sum = _mm256_setzero_si256();
    for (int y = 0; y < FL_PATCH; y++, target += pitch, source += FL_PATCH) {
        for (int x = 0; x < FL_PATCH; x++)
            sum = _mm256_add_epi32(sum, fluid_terms(source + x, target + x));
        if ((y == 1 || y == 3) && sum_of(sum) > limit)
            return sum_of(sum);
    }
    return sum_of(sum);
}
