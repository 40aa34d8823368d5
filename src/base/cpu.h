/* The instruction sets of the processor, and loops that are compiled once for each. */
#pragma once

/** Instruction sets; a level includes all lower levels. */
enum {
    FL_CPU_AVX2 = 1,
    FL_CPU_AVX512 = 2,
    FL_CPU_NEON = 4,
};

/** The processor's flags, masked by the number in $FLUIDY_CPU_MASK. */
unsigned fl_cpu_flags(void);

/**
 * Defines the static function `name`: it runs the inline function `of` as it is compiled for this
 * processor. Both have these parameters, and the arguments are their names, each in parentheses.
 * All versions give the same bytes.
 */
#ifdef __x86_64__
#define FL_FOR_EACH_CPU(name, of, parameters, arguments)                                           \
    __attribute__((target("avx512bw,avx512vl,avx512dq"),                                           \
                   flatten)) static void name##_avx512 parameters                                  \
    {                                                                                              \
        of arguments;                                                                              \
    }                                                                                              \
    __attribute__((target("avx2"), flatten)) static void name##_avx2 parameters                    \
    {                                                                                              \
        of arguments;                                                                              \
    }                                                                                              \
    static void name parameters                                                                    \
    {                                                                                              \
        const unsigned flags = fl_cpu_flags();                                                     \
        if (flags & FL_CPU_AVX512)                                                                 \
            name##_avx512 arguments;                                                               \
        else if (flags & FL_CPU_AVX2)                                                              \
            name##_avx2 arguments;                                                                 \
        else                                                                                       \
            of arguments;                                                                          \
    }
#else
#define FL_FOR_EACH_CPU(name, of, parameters, arguments)                                           \
    static void name parameters                                                                    \
    {                                                                                              \
        of arguments;                                                                              \
    }
#endif
