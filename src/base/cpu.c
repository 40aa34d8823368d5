#include "base/cpu.h"

#include <glib.h>
#include <stdlib.h>

static unsigned find_flags(void)
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

unsigned fl_cpu_flags(void)
{
    static gsize found; // one more than the flags, since 0 is none yet
    if (g_once_init_enter(&found))
        g_once_init_leave(&found, 1 + find_flags());
    return (unsigned)found - 1;
}
