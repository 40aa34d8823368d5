#define ROWS(name) name##_c
#define ROWS_NAME "c"
#define ROWS_FLAGS 0
#include "base/row_kernels.inc"

#include "config.h"
#include <glib.h>
#include <stdlib.h>

unsigned fl_cpu_flags(void)
{
    unsigned flags = 0;
#if defined(__x86_64__)
    __builtin_cpu_init();
    if (__builtin_cpu_supports("avx2"))
        flags |= FL_CPU_AVX2;
    if (__builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512vl") &&
        __builtin_cpu_supports("avx512dq"))
        flags |= FL_CPU_AVX512;
#elif defined(__aarch64__)
    flags |= FL_CPU_NEON;
#endif
    const char *mask = getenv("FLUIDY_CPU_MASK");
    return mask ? flags & (unsigned)strtoul(mask, NULL, 0) : flags;
}

const FlRowKernels *fl_row_kernels_for(unsigned flags)
{
#if HAVE_AVX512
    if (flags & FL_CPU_AVX512)
        return &fl_row_kernels_avx512;
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        return &fl_row_kernels_avx2;
#endif
    return &fl_row_kernels_c; // the compiler uses NEON in it on ARM
}

const FlRowKernels *fl_row_kernels(void)
{
    static gsize chosen;
    if (g_once_init_enter(&chosen))
        g_once_init_leave(&chosen, (gsize)fl_row_kernels_for(fl_cpu_flags()));
    return (const FlRowKernels *)chosen;
}
