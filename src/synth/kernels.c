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

void fl_draw_candidates_c(const FlSearchWindows *windows, const uint16_t centre[3], uint32_t key,
                          FlCandidates *candidates)
{
    for (int k = 0; k < windows->n; k++) {
        candidates->pixel[k] = 0;
        for (int axis = 0; axis < 3; axis++) {
            const int reach = windows->reach[axis][k], last = windows->size[axis] - 1;
            const int low = MAX(centre[axis] - reach, 0), high = MIN(centre[axis] + reach, last);
            const uint32_t place = (uint32_t)(axis * FL_MAX_CANDIDATES + k) / 2; // 16 bits for each
            const uint32_t bits = fl_hash32(key + place * FL_HASH32_STEP) >> (k % 2 * 16) & 0xffff;
            const uint32_t at = (uint32_t)low + (bits * (uint32_t)(high - low + 1) >> 16);
            candidates->at[axis][k] = (uint16_t)at;
            candidates->pixel[k] += at * windows->step[axis];
        }
    }
}

/* The share of a match's use that a cell so many cells away gets. */
static int share(int apart)
{
    return MAX(2 - abs(apart), 0);
}

static uint32_t uniformity_of(const FlCandidates *candidates, int k,
                              const FlCandidateFilter *filter)
{
    uint32_t index = 0;
    int own = 1;
    for (int axis = 0; axis < 3; axis++) {
        const uint32_t cell = (2u * candidates->at[axis][k] + 1) * filter->factor[axis] >> 16;
        index += cell * filter->step[axis];
        own *= share((int)cell - filter->own[axis]);
    }
    const int use = filter->use[index] - own;
    return (uint32_t)MIN((float)MAX(use, 0) * filter->price, filter->most);
}

uint64_t fl_filter_candidates_c(const FlCandidates *candidates, int n,
                                const FlCandidateFilter *filter, uint32_t *uniformity)
{
    uint64_t passed = 0;
    for (int k = 0; k < n; k++) {
        const int16_t frame = (int16_t)candidates->at[2][k], *frames = filter->frames;
        if (filter->first[candidates->pixel[k]].c[FL_CH_SEGMENT] != filter->segment)
            continue;
        uniformity[k] = uniformity_of(candidates, k, filter);
        if (uniformity[k] < filter->limit || frame == frames[0] || frame == frames[1] ||
            frame == frames[2] || frame == frames[3])
            passed |= 1ull << k;
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
    *kernels = (FlKernels){fl_patch_distance_c,    patch_pair_c,        fl_draw_candidates_c,
                           fl_filter_candidates_c, fl_spline_sample_c,  fl_vote_c,
                           fl_vote_doubled_c,      fl_fluid_distance_c, "c"};
#if HAVE_NEON
    if (flags & FL_CPU_NEON) {
        kernels->patch_distance = fl_patch_distance_neon;
        kernels->name = "neon";
    }
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        *kernels =
            (FlKernels){fl_patch_distance_avx2,    fl_patch_pair_avx2,     fl_draw_candidates_avx2,
                        fl_filter_candidates_avx2, fl_spline_sample_avx2,  fl_vote_avx2,
                        fl_vote_doubled_avx2,      fl_fluid_distance_avx2, "avx2"};
#endif
}
