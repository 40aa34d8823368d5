#include "synth/kernels.h"

#include "config.h"
#include <stdbool.h>
#include <stdlib.h>

uint32_t fl_patch_distance_c(const FlTexel *centre, const int32_t *offsets, const FlPacked *target,
                             const FlPacked *weight, uint32_t limit)
{
    uint32_t sum = 0;
    for (int p = 0; p < FL_PATCH_PIXELS && sum <= limit; p++) {
        const FlTexel *source = centre + offsets[p];
        for (int c = 0; c < FL_CHANNELS; c++) {
            const int d = FL_FINE * source->c[c] - target[p].c[c];
            sum += (uint32_t)(d * ((d * weight[p].c[c] + (1 << 14)) >> 15));
        }
    }
    return sum;
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

static bool is_near(uint16_t a, uint16_t b)
{
    return abs((int16_t)(uint16_t)(a - b)) < FL_SAME_PLACE;
}

static void join(const FlVotes *votes, int k, FlOpinion *opinion)
{
    opinion->sum_x += votes->x[k] - opinion->x;
    opinion->sum_y += votes->y[k] - opinion->y;
    opinion->n++;
}

int fl_find_opinions_c(const FlVotes *votes, FlOpinion *opinions)
{
    int n = 0;
    uint32_t left = 0;
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        left |= (uint32_t)(votes->frame[k] >= 0) << k;
    while (left) {
        const int leader = __builtin_ctz(left);
        FlOpinion *o = &opinions[n++];
        *o = (FlOpinion){
            .x = votes->x[leader], .y = votes->y[leader], .frame = votes->frame[leader]};
        for (int k = leader; k < FL_PATCH_PIXELS; k++)
            if (left >> k & 1 && votes->frame[k] == o->frame &&
                is_near(votes->x[k], votes->x[leader]) && is_near(votes->y[k], votes->y[leader])) {
                join(votes, k, o);
                left &= ~(1u << k);
            }
    }
    return n;
}

unsigned fl_cpu_flags(void)
{
    unsigned flags = 0;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2"))
        flags |= FL_CPU_AVX2;
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl"))
        flags |= FL_CPU_AVX512;
#elif defined(__aarch64__)
    flags |= FL_CPU_NEON;
#endif
    const char *mask = getenv("FLUIDY_CPU_MASK");
    return mask ? flags & (unsigned)strtoul(mask, NULL, 0) : flags;
}

void fl_kernels_init(FlKernels *kernels, unsigned flags)
{
    *kernels = (FlKernels){fl_patch_distance_c, fl_spline_sample_c, fl_find_opinions_c, "c"};
#if HAVE_NEON
    if (flags & FL_CPU_NEON) {
        kernels->patch_distance = fl_patch_distance_neon;
        kernels->name = "neon";
    }
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        *kernels = (FlKernels){fl_patch_distance_avx2, fl_spline_sample_avx2, fl_find_opinions_avx2,
                               "avx2"};
#endif
#if HAVE_AVX512
    if (flags & FL_CPU_AVX512) {
        kernels->patch_distance = fl_patch_distance_avx512;
        kernels->opinions = fl_find_opinions_avx512;
        kernels->name = "avx512";
    }
#endif
}
