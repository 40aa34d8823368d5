/* Four pixels of a patch at a time, 32 candidates or votes. */
#include "base/rng.h"
#include "synth/kernels.h"

#include <immintrin.h>

static inline __m128i load_two(const FlTexel *centre, const int16_t *offsets)
{
    const __m128d first = _mm_load_sd((const double *)(centre + offsets[0]));
    return _mm_castpd_si128(_mm_loadh_pd(first, (const double *)(centre + offsets[1])));
}

static inline __m256i load_four(const FlTexel *centre, const int16_t *offsets)
{
    return _mm256_inserti128_si256(_mm256_castsi128_si256(load_two(centre, offsets)),
                                   load_two(centre, offsets + 2), 1);
}

/* The weights of four pixels: each one's for its colours, the rest for the other channels. */
static inline __m512i weights_of(__m512i target, __m512i rest)
{
    const __m128i colour =
        _mm_setr_epi8(12, 13, 12, 13, 12, 13, -1, -1, -1, -1, -1, -1, -1, -1, -1, -1);
    return _mm512_mask_shuffle_epi8(rest, 0x003f003f003f003f, target,
                                    _mm512_broadcast_i32x4(colour));
}

/* The weights of the other channels of four pixels. */
static inline __m512i load_rest(const FlTargetTexel *rest)
{
    const __m128i others = _mm_setr_epi16(0, 0, 0, -1, -1, -1, 0, 0);
    return _mm512_broadcast_i32x4(_mm_and_si128(others, _mm_loadu_si128((const __m128i *)rest)));
}

static inline __m512i four_terms(__m256i texels, __m512i target, __m512i weight)
{
    const __m512i s = _mm512_slli_epi16(_mm512_cvtepu8_epi16(texels), 4); // to the target's steps
    const __m512i d = _mm512_sub_epi16(s, target);
    return _mm512_madd_epi16(d, _mm512_mulhrs_epi16(d, weight));
}

/* The last pixel of 25; the texel stands alone. */
static inline __m512i last_term(__m128i texel, const FlTargetTexel *target, __m512i rest)
{
    const __m512i t = _mm512_zextsi128_si512(_mm_load_si128((const __m128i *)(target + 24)));
    const __m512i terms = four_terms(_mm256_zextsi128_si256(texel), t, weights_of(t, rest));
    return _mm512_maskz_mov_epi32(0xf, terms);
}

/* Not _mm512_reduce_add_epi32(): gcc's ends in a sum of signed numbers, which may overflow. */
static inline uint32_t sum_of(__m512i v)
{
    const __m256i half =
        _mm256_add_epi32(_mm512_castsi512_si256(v), _mm512_extracti64x4_epi64(v, 1));
    __m128i sum = _mm_add_epi32(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
    sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, _MM_SHUFFLE(1, 0, 3, 2)));
    sum = _mm_add_epi32(sum, _mm_shuffle_epi32(sum, _MM_SHUFFLE(2, 3, 0, 1)));
    return (uint32_t)_mm_cvtsi128_si32(sum);
}

/* Byte order of two pixels whose extents change places. */
static inline __m128i opposed_order(void)
{
    return _mm_setr_epi8(0, 1, 2, 3, 5, 4, 6, 7, 8, 9, 10, 11, 13, 12, 14, 15);
}

uint32_t fl_patch_distance_avx512(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                  const FlTargetTexel *target, const FlTargetTexel *rest,
                                  uint32_t limit)
{
    const __m128i straight = _mm_setr_epi8(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
    const __m128i one = opposed ? opposed_order() : straight;
    const __m256i order = _mm256_broadcastsi128_si256(one);
    const __m512i others = load_rest(rest);
    __m512i sum = _mm512_setzero_si512();
    for (int p = 0; p < 24; p += 4) {
        const __m256i texels = _mm256_shuffle_epi8(load_four(centre, offsets + p), order);
        const __m512i t = _mm512_load_si512(target + p);
        sum = _mm512_add_epi32(sum, four_terms(texels, t, weights_of(t, others)));
        if (p == 4 && sum_of(sum) > limit)
            return sum_of(sum);
    }
    const __m128i texel = _mm_loadl_epi64((const __m128i *)(centre + offsets[24]));
    return sum_of(_mm512_add_epi32(sum, last_term(_mm_shuffle_epi8(texel, one), target, others)));
}

void fl_patch_pair_avx512(const FlTexel *centre, const int16_t *offsets,
                          const FlTargetTexel *target, const FlTargetTexel *rest, uint32_t limit,
                          uint32_t distance[2])
{
    const __m256i turned = _mm256_broadcastsi128_si256( // swaps two pixels and their extents
        _mm_setr_epi8(8, 9, 10, 11, 13, 12, 14, 15, 0, 1, 2, 3, 5, 4, 6, 7));
    const __m512i others = load_rest(rest);
    __m512i sum = _mm512_setzero_si512(), turned_sum = sum;
    for (int p = 0; p < 24; p += 4) {
        const __m256i texels = load_four(centre, offsets + p);
        const __m512i t = _mm512_load_si512(target + p), w = weights_of(t, others);
        sum = _mm512_add_epi32(sum, four_terms(texels, t, w));
        turned_sum =
            _mm512_add_epi32(turned_sum, four_terms(_mm256_shuffle_epi8(texels, turned), t, w));
        if (p == 4) {
            distance[0] = sum_of(sum), distance[1] = sum_of(turned_sum);
            if (distance[0] > limit && distance[1] > limit)
                return;
        }
    }
    const __m128i texel = _mm_loadl_epi64((const __m128i *)centre);
    const __m128i opposed = _mm_shuffle_epi8(texel, opposed_order());
    distance[0] = sum_of(_mm512_add_epi32(sum, last_term(texel, target, others)));
    distance[1] = sum_of(_mm512_add_epi32(turned_sum, last_term(opposed, target, others)));
}

/* fl_hash32() of sixteen lanes. */
static inline __m512i hash(__m512i v)
{
    v = _mm512_xor_si512(v, _mm512_srli_epi32(v, 16));
    v = _mm512_mullo_epi32(v, _mm512_set1_epi32(0x7feb352d));
    v = _mm512_xor_si512(v, _mm512_srli_epi32(v, 15));
    v = _mm512_mullo_epi32(v, _mm512_set1_epi32((int)0x846ca68bu));
    return _mm512_xor_si512(v, _mm512_srli_epi32(v, 16));
}

/* 32 candidates along one axis, from the k-th on. */
static inline __m512i draw_along(const FlSearchWindows *windows, const uint16_t centre[3],
                                 uint32_t key, int axis, int k)
{
    const uint32_t place = (uint32_t)(axis * FL_MAX_CANDIDATES + k) / 2;
    const __m512i lane =
        _mm512_mullo_epi32(_mm512_set1_epi32((int)FL_HASH32_STEP),
                           _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15));
    const __m512i bits =
        hash(_mm512_add_epi32(_mm512_set1_epi32((int)(key + place * FL_HASH32_STEP)), lane));
    const __m512i c = _mm512_set1_epi16((int16_t)centre[axis]);
    const __m512i reach = _mm512_load_si512(windows->reach[axis] + k);
    const __m512i end = _mm512_set1_epi16((int16_t)windows->size[axis]);
    const __m512i low = _mm512_subs_epu16(c, reach);
    const __m512i high = // exclusive
        _mm512_min_epu16(_mm512_adds_epu16(_mm512_adds_epu16(c, reach), _mm512_set1_epi16(1)), end);
    return _mm512_add_epi16(low, _mm512_mulhi_epu16(bits, _mm512_sub_epi16(high, low)));
}

/* Sixteen 16-bit places times the step to the next. */
static inline __m512i steps(__m256i at, uint32_t step)
{
    return _mm512_mullo_epi32(_mm512_cvtepu16_epi32(at), _mm512_set1_epi32((int)step));
}

void fl_draw_candidates_avx512(const FlSearchWindows *windows, const uint16_t centre[3],
                               uint32_t key, FlCandidates *candidates)
{
    for (int k = 0; k < windows->n; k += 32) {
        __m512i low = _mm512_setzero_si512(), high = low;
        for (int axis = 0; axis < 3; axis++) {
            const __m512i at = draw_along(windows, centre, key, axis, k);
            _mm512_store_si512(candidates->at[axis] + k, at);
            low = _mm512_add_epi32(low, steps(_mm512_castsi512_si256(at), windows->step[axis]));
            high = _mm512_add_epi32(high,
                                    steps(_mm512_extracti64x4_epi64(at, 1), windows->step[axis]));
        }
        _mm512_store_si512(candidates->pixel + k, low);
        _mm512_store_si512(candidates->pixel + k + 16, high);
    }
}

/* The cells of 32 candidates along an axis; takes their part of the pixel's own use into `own`. */
static inline __m512i cells_along(const FlCandidates *candidates, const FlCandidateFilter *filter,
                                  int axis, int k, __m512i *own)
{
    const __m512i at = _mm512_load_si512(candidates->at[axis] + k), two = _mm512_set1_epi16(2);
    const __m512i odd = _mm512_add_epi16(_mm512_add_epi16(at, at), _mm512_set1_epi16(1));
    const __m512i cell = _mm512_mulhi_epu16(odd, _mm512_set1_epi16((int16_t)filter->factor[axis]));
    const __m512i apart =
        _mm512_abs_epi16(_mm512_sub_epi16(cell, _mm512_set1_epi16((int16_t)filter->own[axis])));
    *own = _mm512_mullo_epi16(*own, _mm512_subs_epu16(two, apart));
    return cell;
}

/* The uniformity term of sixteen cells. */
static inline __m512i uniformity_at(const FlCandidateFilter *filter, __m512i index, __m256i own)
{
    const __m512i use =
        _mm512_sub_epi32(_mm512_i32gather_epi32(index, filter->use, 4), _mm512_cvtepu16_epi32(own));
    const __m512 counted = _mm512_cvtepi32_ps(_mm512_max_epi32(use, _mm512_setzero_si512()));
    return _mm512_cvttps_epi32(_mm512_min_ps(_mm512_mul_ps(counted, _mm512_set1_ps(filter->price)),
                                             _mm512_set1_ps(filter->most)));
}

/* The mask of those of sixteen texels that are of the segment. */
static inline __mmask16 of_segment(const FlCandidateFilter *filter, const uint32_t *pixel)
{
    const __m512i last_bytes = _mm512_i32gather_epi32(
        _mm512_load_si512(pixel), (const int *)(const void *)&filter->first->c[4], sizeof(FlTexel));
    return _mm512_cmpeq_epi32_mask(_mm512_srli_epi32(last_bytes, 24),
                                   _mm512_set1_epi32(filter->segment));
}

uint64_t fl_filter_candidates_avx512(const FlCandidates *candidates, int n,
                                     const FlCandidateFilter *filter, uint32_t *uniformity)
{
    uint64_t passed = 0;
    for (int k = 0; k < n; k += 32) {
        __m512i low = _mm512_setzero_si512(), high = low, own = _mm512_set1_epi16(1);
        for (int axis = 0; axis < 3; axis++) {
            const __m512i cell = cells_along(candidates, filter, axis, k, &own);
            low = _mm512_add_epi32(low, steps(_mm512_castsi512_si256(cell), filter->step[axis]));
            high = _mm512_add_epi32(high,
                                    steps(_mm512_extracti64x4_epi64(cell, 1), filter->step[axis]));
        }
        low = uniformity_at(filter, low, _mm512_castsi512_si256(own));
        high = uniformity_at(filter, high, _mm512_extracti64x4_epi64(own, 1));
        _mm512_storeu_si512(uniformity + k, low);
        _mm512_storeu_si512(uniformity + k + 16, high);
        const __m512i limit = _mm512_set1_epi32((int)filter->limit);
        __mmask32 good = _mm512_kunpackw(_mm512_cmplt_epu32_mask(high, limit),
                                         _mm512_cmplt_epu32_mask(low, limit));
        const __m512i frame = _mm512_load_si512(candidates->at[2] + k);
        for (int f = 0; f < 4; f++)
            good |= _mm512_cmpeq_epi16_mask(frame, _mm512_set1_epi16(filter->frames[f]));
        good &= _mm512_kunpackw(of_segment(filter, candidates->pixel + k + 16),
                                of_segment(filter, candidates->pixel + k));
        passed |= (uint64_t)good << k;
    }
    return n < 64 ? passed & ((1ull << n) - 1) : passed;
}

/* From columns to rows: 16-bit numbers, and the lower halves of 32-bit ones. */
static inline __m512i rows_of(__m512i numbers)
{
    return _mm512_permutexvar_epi16(_mm512_set_epi16(31, 30, 29, 28, 27, 26, 25, 24, 19, 14, 9, 4,
                                                     23, 18, 13, 8, 3, 22, 17, 12, 7, 2, 21, 16, 11,
                                                     6, 1, 20, 15, 10, 5, 0),
                                    numbers);
}

static inline __m512i rows_of_both(__m512i low, __m512i high)
{
    return _mm512_permutex2var_epi16(low,
                                     _mm512_set_epi16(62, 60, 58, 56, 54, 52, 50, 48, 38, 28, 18, 8,
                                                      46, 36, 26, 16, 6, 44, 34, 24, 14, 4, 42, 32,
                                                      22, 12, 2, 40, 30, 20, 10, 0),
                                     high);
}

/* Along one axis, how far the middle is from the matches as they are turned: madd of cosines and
 * sines. */
static inline __m512i offsets_along(const int16_t (*turn)[2], const int16_t (*step)[2])
{
    const __m512i half = _mm512_set1_epi32(1 << 9);
    const __m512i low = _mm512_madd_epi16(_mm512_loadu_si512(turn), _mm512_load_si512(step));
    const __m512i high =
        _mm512_madd_epi16(_mm512_loadu_si512(turn + 16), _mm512_load_si512(step + 16));
    return rows_of_both(_mm512_srai_epi32(_mm512_add_epi32(low, half), 10),
                        _mm512_srai_epi32(_mm512_add_epi32(high, half), 10));
}

static inline __mmask32 near_zero(__m512i difference)
{
    return _mm512_cmplt_epi16_mask(_mm512_abs_epi16(difference), _mm512_set1_epi16(FL_SAME_PLACE));
}

/* The sums of differences over the lanes of a mask, x in the lower half and y in the upper, each
 * plus 32 a lane: a difference is a byte then. */
static inline __m128i sums_of(__m512i dx, __m512i dy, __mmask32 mask)
{
    const __m512i apart =
        _mm512_broadcast_i32x4(_mm_setr_epi8(0, 2, 4, 6, 8, 10, 12, 14, 1, 3, 5, 7, 9, 11, 13, 15));
    __m512i both = _mm512_add_epi16(dx, _mm512_slli_epi16(dy, 8));
    both = _mm512_maskz_add_epi16(mask, both, _mm512_set1_epi16(0x2020));
    both = _mm512_sad_epu8(_mm512_shuffle_epi8(both, apart), _mm512_setzero_si512());
    const __m256i half =
        _mm256_add_epi64(_mm512_castsi512_si256(both), _mm512_extracti64x4_epi64(both, 1));
    return _mm_add_epi64(_mm256_castsi256_si128(half), _mm256_extracti128_si256(half, 1));
}

/* 65536 / n, rounded up: v * that >> 16 is v / n for v < 2600. */
static const uint32_t inverse[FL_PATCH_PIXELS + 1] = {
    0,    65536, 32768, 21846, 16384, 13108, 10923, 9363, 8192, 7282, 6554, 5958, 5462,
    5042, 4682,  4370,  4096,  3856,  3641,  3450,  3277, 3121, 2979, 2850, 2731, 2622};

/* The mean place of n votes, x and y in 64-bit lanes, equal to mean_of(). */
static inline __m128i mean_place(__m128i first, __m128i sums, int n)
{
    const __m128i sum = _mm_sub_epi32(sums, _mm_set1_epi64x(32 * n));
    const __m128i rounded = _mm_add_epi32(_mm_abs_epi32(sum), _mm_set1_epi64x(n / 2));
    const __m128i mean = _mm_srli_epi64(_mm_mul_epu32(rounded, _mm_set1_epi64x(inverse[n])), 16);
    return _mm_add_epi32(_mm_sub_epi32(first, _mm_set1_epi64x(FL_VOTE_BIAS)),
                         _mm_sign_epi32(mean, sum));
}

/* Two rows of four pixels as pairs of one channel, times the pairs of weights. */
static inline __m512i two_row_sums(const FlSplinePixel *first, size_t pitch, __m512i x)
{
    const __m512i pairs =
        _mm512_broadcast_i32x4(_mm_setr_epi8(0, 1, 8, 9, 2, 3, 10, 11, 4, 5, 12, 13, 6, 7, 14, 15));
    const __m512i rows =
        _mm512_inserti64x4(_mm512_castsi256_si512(_mm256_loadu_si256((const __m256i *)first)),
                           _mm256_loadu_si256((const __m256i *)(first + pitch)), 1);
    return _mm512_madd_epi16(_mm512_shuffle_epi8(rows, pairs), x);
}

/* The spline's value, by the contract of FlSplineSample. */
static inline __m128 sample(const FlSplinePixel *first, size_t pitch, const FlSplinePhase *x,
                            const FlSplinePhase *y)
{
    const __m512i weights = _mm512_broadcast_i64x4(_mm256_load_si256((const __m256i *)x->x));
    const __m512i upper = two_row_sums(first, pitch, weights);
    const __m512i lower = two_row_sums(first + 2 * pitch, pitch, weights);
    const __m512i rows =
        _mm512_add_epi32(_mm512_shuffle_i64x2(upper, lower, _MM_SHUFFLE(2, 0, 2, 0)),
                         _mm512_shuffle_i64x2(upper, lower, _MM_SHUFFLE(3, 1, 3, 1)));
    const __m512 each =
        _mm512_permutexvar_ps(_mm512_setr_epi32(0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3),
                              _mm512_castps128_ps512(_mm_load_ps(y->y)));
    const __m512 parts = _mm512_mul_ps(each, _mm512_cvtepi32_ps(rows));
    __m128 sum = _mm_add_ps(_mm512_castps512_ps128(parts), _mm512_extractf32x4_ps(parts, 1));
    sum = _mm_add_ps(sum, _mm512_extractf32x4_ps(parts, 2));
    return _mm_add_ps(sum, _mm512_extractf32x4_ps(parts, 3));
}

/* The places that votes point to. */
typedef struct Places {
    __m512i x, y, frame;
} Places;

static inline Places places_of(const FlVoteMatches *covering)
{
    return (Places){
        _mm512_add_epi16(rows_of(_mm512_loadu_si512(covering->x)),
                         offsets_along(covering->turn, fl_vote_steps[0])),
        _mm512_add_epi16(rows_of(_mm512_loadu_si512(covering->y)),
                         offsets_along(covering->turn, fl_vote_steps[1])),
        rows_of(_mm512_loadu_si512(covering->frame)),
    };
}

/* Those of the votes `left` that agree with the first of them, and its place in every lane. */
static inline __mmask32 agreeing(const Places *at, __mmask32 left, Places *first)
{
    const __m512i k = _mm512_set1_epi16((int16_t)__builtin_ctz(left));
    *first = (Places){_mm512_permutexvar_epi16(k, at->x), _mm512_permutexvar_epi16(k, at->y),
                      _mm512_permutexvar_epi16(k, at->frame)};
    left = _mm512_mask_cmpeq_epi16_mask(left, at->frame, first->frame);
    return left & near_zero(_mm512_sub_epi16(at->x, first->x)) &
           near_zero(_mm512_sub_epi16(at->y, first->y));
}

/* The place of a cluster of n votes, x and y in 64-bit lanes. */
static inline __m128i place_of(const Places *at, __mmask32 votes, int n, const Places *first)
{
    const __m128i sums =
        sums_of(_mm512_sub_epi16(at->x, first->x), _mm512_sub_epi16(at->y, first->y), votes);
    const __m128i lead = _mm_and_si128(
        _mm_unpacklo_epi64(_mm512_castsi512_si128(first->x), _mm512_castsi512_si128(first->y)),
        _mm_set1_epi64x(0xffff));
    return mean_place(lead, sums, n);
}

/* The colour of a cluster, by the frame of its first vote and its place, which may lie beyond the
 * borders. */
static inline __m128 cluster_colour(const Places *first, __m128i place, const FlVoteSource *voted)
{
    const __m128i end = _mm_cvtepi32_epi64(_mm_loadl_epi64((const __m128i *)voted->most));
    place = _mm_min_epi32(_mm_max_epi32(place, _mm_setzero_si128()), end);
    const uint32_t x = (uint32_t)_mm_cvtsi128_si32(place);
    const uint32_t y = (uint32_t)_mm_extract_epi32(place, 2);
    const uint32_t frame =
        (uint32_t)_mm_cvtsi128_si32(_mm512_castsi512_si128(first->frame)) & 0xffff;
    return sample(voted->colour + frame * voted->frame_pixels + (y >> 4) * voted->pitch + (x >> 4),
                  voted->pitch, &fl_spline_phases[x & 15], &fl_spline_phases[y & 15]);
}

static inline __m128 add_weighted(__m128 sum, float weight, __m128 value)
{
    return _mm_add_ps(sum, _mm_mul_ps(_mm_set1_ps(weight), value));
}

static inline void store_colour(__m128 sum, float total, float colour[4])
{
    sum = _mm_div_ps(sum, _mm_set1_ps(total));
    _mm_storeu_ps(colour, _mm_min_ps(_mm_max_ps(sum, _mm_setzero_ps()), _mm_set1_ps(1)));
}

bool fl_vote_avx512(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4])
{
    const __m512i frames = rows_of(_mm512_loadu_si512(covering->frame));
    __mmask32 left = ((1u << FL_PATCH_PIXELS) - 1) & ~_mm512_movepi16_mask(frames);
    if (!left)
        return false;
    const Places at = places_of(covering);
    __m128 sum = _mm_setzero_ps();
    float total = 0;
    while (left) {
        Places first;
        const __mmask32 votes = agreeing(&at, left, &first);
        const int n = __builtin_popcount(votes);
        const __m128i place = place_of(&at, votes, n, &first);
        sum = add_weighted(sum, voted->weight[n], cluster_colour(&first, place, voted));
        total += voted->weight[n];
        left &= ~votes;
    }
    store_colour(sum, total, colour);
    return true;
}

/* Places in twice the size. */
static inline __m512i doubled(__m512i places)
{
    return _mm512_sub_epi16(_mm512_slli_epi16(places, 1), _mm512_set1_epi16(FL_VOTE_BIAS));
}

bool fl_vote_doubled_avx512(const FlVoteMatches *covering, const FlVoteSource *voted,
                            float colour[4][4])
{
    const __m512i frames = rows_of(_mm512_loadu_si512(covering->frame));
    __mmask32 left = ((1u << FL_PATCH_PIXELS) - 1) & ~_mm512_movepi16_mask(frames);
    if (!left)
        return false;
    const Places half = places_of(covering);
    const Places at = {doubled(half.x), doubled(half.y), half.frame};
    __m128 sum[4] = {_mm_setzero_ps(), _mm_setzero_ps(), _mm_setzero_ps(), _mm_setzero_ps()};
    float total = 0;
    while (left) {
        Places first;
        const int leader = __builtin_ctz(left);
        const __mmask32 votes = agreeing(&at, left, &first);
        const int n = __builtin_popcount(votes);
        const __m128i place = place_of(&at, votes, n, &first);
        const int16_t *turn = covering->turn[leader % FL_PATCH * FL_PATCH + leader / FL_PATCH];
        for (int child = 0; child < 4; child++) {
            const FlOffset move = fl_child_move(turn, child % 2, child / 2);
            const __m128i moved = _mm_add_epi32(place, _mm_set_epi64x(move.y, move.x));
            sum[child] =
                add_weighted(sum[child], voted->weight[n], cluster_colour(&first, moved, voted));
        }
        total += voted->weight[n];
        left &= ~votes;
    }
    for (int child = 0; child < 4; child++)
        store_colour(sum[child], total, colour[child]);
    return true;
}

/* In 16 bits: a place that overflows is above `most` anyway, and with 8 more no move is negative.
 */
void fl_upscale_row_avx512(const FlMatch *coarse, const FlOffset (*moves)[2],
                           const uint16_t most[2], FlMatch *fine, int n)
{
    const __m512i least = _mm512_set1_epi16(8);
    const __m512i limit = _mm512_set1_epi32((int)(most[0] | (uint32_t)most[1] << 16));
    const __m512i first = _mm512_setr_epi64(0, 1, 8, 9, 2, 3, 10, 11);
    const __m512i second = _mm512_setr_epi64(4, 5, 12, 13, 6, 7, 14, 15);
    int i = 0;
    for (; i + 16 <= n; i += 16) {
        const __m512i m = _mm512_loadu_si512(coarse + i / 2);
        const __m512i theta = _mm512_and_si512(_mm512_srli_epi64(m, 48), _mm512_set1_epi64(255));
        const __m512i move = _mm512_i64gather_epi64(theta, moves, 8);
        const __m512i rest = _mm512_shuffle_epi32(m, _MM_PERM_DDBB);
        __m512i p = _mm512_shuffle_epi32(m, _MM_PERM_CCAA); // of both children
        p = _mm512_adds_epu16(_mm512_adds_epu16(p, p), _mm512_add_epi16(move, least));
        p = _mm512_min_epu16(_mm512_subs_epu16(p, least), limit);
        const __m512i even = _mm512_unpacklo_epi32(p, rest), odd = _mm512_unpackhi_epi32(p, rest);
        _mm512_storeu_si512(fine + i, _mm512_permutex2var_epi64(even, first, odd));
        _mm512_storeu_si512(fine + i + 8, _mm512_permutex2var_epi64(even, second, odd));
    }
    fl_upscale_row_c(coarse + i / 2, moves, most, fine + i, n - i);
}
