#include "synth/kernels.h"

#include "config.h"
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
    *kernels = (FlKernels){.patch_distance = fl_patch_distance_c, .name = "c"};
#if HAVE_NEON
    if (flags & FL_CPU_NEON)
        *kernels = (FlKernels){.patch_distance = fl_patch_distance_neon, .name = "neon"};
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        *kernels = (FlKernels){.patch_distance = fl_patch_distance_avx2, .name = "avx2"};
#endif
#if HAVE_AVX512
    if (flags & FL_CPU_AVX512)
        *kernels = (FlKernels){.patch_distance = fl_patch_distance_avx512, .name = "avx512"};
#endif
}
