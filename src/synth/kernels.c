#include "synth/kernels.h"

#include "base/rng.h"
#include "config.h"
#include <glib.h>
#include <stdlib.h>

/* One pixel's share of a distance. */
static uint32_t term(const FlTexel *source, bool opposed, const FlTargetTexel *target,
                     const FlTargetTexel *rest)
{
    FlTexel s = *source;
    if (opposed) {
        s.c[FL_CH_EXT_PLUS] = source->c[FL_CH_EXT_MINUS];
        s.c[FL_CH_EXT_MINUS] = source->c[FL_CH_EXT_PLUS];
    }
    uint32_t sum = 0;
    for (int c = 0; c < FL_WEIGHED_CHANNELS; c++) {
        const int d = FL_FINE * s.c[c] - target->c[c];
        const int weight = c <= FL_CH_B ? target->c[FL_CH_COLOUR_WEIGHT] : rest->c[c];
        sum += (uint32_t)(d * ((d * weight + (1 << 14)) >> 15));
    }
    return sum;
}

uint32_t fl_patch_distance_c(const FlTexel *centre, const int16_t *offsets, bool opposed,
                             const FlTargetTexel *target, const FlTargetTexel *rest, uint32_t limit)
{
    uint32_t sum = 0;
    for (int p = 0; p < FL_PATCH_PIXELS && sum <= limit; p++)
        sum += term(centre + offsets[p], opposed, &target[p], rest);
    return sum;
}

static void patch_pair_c(const FlTexel *centre, const int16_t *offsets, const FlTargetTexel *target,
                         const FlTargetTexel *rest, uint32_t limit, uint32_t distance[2])
{
    distance[0] = fl_patch_distance_c(centre, offsets, false, target, rest, limit);
    distance[1] = 0;
    for (int p = 0; p < FL_PATCH_PIXELS && distance[1] <= limit; p++)
        distance[1] += term(centre - offsets[p], true, &target[p], rest);
}

/* Loops go on to a multiple of 16, which compilers make of vectors alone; what lies beyond the
 * windows does not count. */
static int whole_vectors(int n)
{
    return (n + 15) & ~15;
}

/* Candidates along one axis. */
static inline void draw_along(const FlSearchWindows *windows, const uint16_t centre[3],
                              uint32_t key, int axis, FlCandidates *candidates)
{
    const int middle = centre[axis], last = windows->size[axis] - 1;
    const int n = whole_vectors(windows->n);
    uint16_t bits[FL_MAX_CANDIDATES];
    for (int k = 0; k < n; k += 2) {
        const uint32_t place = (uint32_t)(axis * FL_MAX_CANDIDATES + k) / 2;
        const uint32_t both = fl_hash32(key + place * FL_HASH32_STEP);
        bits[k] = (uint16_t)both, bits[k + 1] = (uint16_t)(both >> 16);
    }
    for (int k = 0; k < n; k++) {
        const int reach = windows->reach[axis][k];
        const int low = MAX(middle - reach, 0), high = MIN(middle + reach, last);
        const uint32_t at = (uint32_t)low + (bits[k] * (uint32_t)(high - low + 1) >> 16);
        candidates->at[axis][k] = (uint16_t)at;
        candidates->pixel[k] += at * windows->step[axis];
    }
}

static inline void draw(const FlSearchWindows *windows, const uint16_t centre[3], uint32_t key,
                        FlCandidates *candidates)
{
    for (int k = 0; k < whole_vectors(windows->n); k++)
        candidates->pixel[k] = 0;
    for (int axis = 0; axis < 3; axis++)
        draw_along(windows, centre, key, axis, candidates);
}

FL_FOR_EACH_CPU(draw_candidates, draw,
                (const FlSearchWindows *windows, const uint16_t centre[3], uint32_t key,
                 FlCandidates *candidates),
                (windows, centre, key, candidates))

void fl_draw_candidates(const FlSearchWindows *windows, const uint16_t centre[3], uint32_t key,
                        FlCandidates *candidates)
{
    draw_candidates(windows, centre, key, candidates);
}

/* The share of a match's use that a cell so many cells away gets. */
static int share(int apart)
{
    return MAX(2 - abs(apart), 0);
}

/* The cells of candidates in the map, and of each the share of the pixel's own use. */
static void find_cells(const FlCandidates *candidates, int n, const FlCandidateFilter *filter,
                       uint32_t *restrict cells, int16_t *restrict own)
{
    for (int k = 0; k < n; k++)
        cells[k] = 0, own[k] = 1;
    for (int axis = 0; axis < 3; axis++)
        for (int k = 0; k < n; k++) {
            const uint32_t cell = (2u * candidates->at[axis][k] + 1) * filter->factor[axis] >> 16;
            cells[k] += cell * filter->step[axis];
            own[k] = (int16_t)(own[k] * share((int)cell - filter->own[axis]));
        }
}

static bool is_among(const int16_t frames[4], int16_t frame)
{
    return (frame == frames[0]) | (frame == frames[1]) | (frame == frames[2]) |
           (frame == frames[3]);
}

uint64_t fl_filter_candidates(const FlCandidates *candidates, int n,
                              const FlCandidateFilter *filter, uint32_t *uniformity)
{
    uint64_t passed = 0;
    uint32_t cells[FL_MAX_CANDIDATES];
    int16_t own[FL_MAX_CANDIDATES];
    find_cells(candidates, whole_vectors(n), filter, cells, own);
    for (int k = 0; k < n; k++) {
        // NOLINTNEXTLINE(clang-analyzer-core.uninitialized.ArraySubscript): all are found
        const int use = MAX(filter->use[cells[k]] - own[k], 0);
        uniformity[k] = (uint32_t)(int32_t)MIN((float)use * filter->price, filter->most);
    }
    for (int k = 0; k < n; k++) {
        const uint8_t segment = filter->first[candidates->pixel[k]].c[FL_CH_SEGMENT];
        const bool good = (uniformity[k] < filter->limit) |
                          is_among(filter->frames, (int16_t)candidates->at[2][k]);
        passed |= (uint64_t)(good & (segment == filter->segment)) << k;
    }
    return passed;
}

void fl_spline_sample_c(const FlSplinePixel *first, size_t pitch, const int16_t *x, const float *y,
                        float value[4])
{
    for (int c = 0; c < 4; c++) {
        value[c] = 0;
        for (int j = 0; j < 4; j++) {
            const FlSplinePixel *row = first + j * pitch;
            const int sum =
                row[0].c[c] * x[0] + row[1].c[c] * x[1] + row[2].c[c] * x[8] + row[3].c[c] * x[9];
            value[c] += y[j] * (float)sum;
        }
    }
}

void fl_kernels_init(FlKernels *kernels, unsigned flags)
{
    *kernels = (FlKernels){
        fl_patch_distance_c, patch_pair_c, fl_spline_sample_c, fl_vote_c, fl_vote_doubled_c,
        fl_fluid_distance_c, "c"};
#if HAVE_NEON
    if (flags & FL_CPU_NEON) {
        kernels->patch_distance = fl_patch_distance_neon;
        kernels->name = "neon";
    }
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        *kernels = (FlKernels){fl_patch_distance_avx2,
                               fl_patch_pair_avx2,
                               fl_spline_sample_avx2,
                               fl_vote_avx2,
                               fl_vote_doubled_avx2,
                               fl_fluid_distance_avx2,
                               "avx2"};
#endif
}
