/* Loops over rows of pixels, compiled once per instruction set. */
#pragma once

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Instruction sets of the processor; a level includes all lower levels. */
enum {
    FL_CPU_AVX2 = 1,
    FL_CPU_AVX512 = 2,
    FL_CPU_NEON = 4,
};

/** The processor's flags, masked by the number in $FLUIDY_CPU_MASK. */
unsigned fl_cpu_flags(void);

/** Pixels being blended, in planes: values 0..65535 times alpha 0..255, and 65535 times alpha. */
typedef struct FlSums {
    uint32_t *x[3], *a;
} FlSums;

/** A row of a layer that upper layers occlude, for fl_layers_resolve(). */
typedef struct FlOcclusion {
    const uint8_t *coverage; // of the whole shape, 0..255
    const uint8_t *seen;     // its visible part of each pixel, 0..255
    const uint8_t *knockout; // of its paint, 0..255; NULL: 255
    int alpha;               // opacity of the layer, 0..255
    bool knocks;             // true if the layer hides those below
} FlOcclusion;

/** A piece of contour: its middle, its inward unit normal, half its length; px. */
typedef struct FlContourPiece {
    float x, y;
    float nx, ny; // 0, 0: not a piece of line but a disc
    float half;   // a disc's radius
} FlContourPiece;

enum { FL_LINKS = 8 }; // links of a piece to its neighbours

/** The pieces around one, side by side; where there are fewer, the rest are that piece itself. */
typedef struct FlContourLinks {
    float x[FL_LINKS], y[FL_LINKS], nx[FL_LINKS], ny[FL_LINKS], half[FL_LINKS];
    int32_t piece[FL_LINKS]; // their indices
    bool has_discs;          // any of them is one
} FlContourLinks;

/** A contour, and for rows y - 1, y and y + 1 the index of a piece near each pixel. */
typedef struct FlContourRow {
    const FlContourPiece *piece;
    const FlContourLinks *links; // of each piece
    const int32_t *above, *own, *below;
    int y;
    float near_px; // farther off than that the own piece will do
} FlContourRow;

/**
 * One version of every loop; all give the same bytes. They have one source, row_kernels.inc, which
 * the compiler vectorises for each instruction set. n is the length of the output, >= 0. Arrays
 * need no alignment and do not overlap.
 */
typedef struct FlRowKernels {
    /** Blur: to[i] += weight * (a[i] + b[i]). a and b may be the same. */
    void (*add_pair)(float *to, const float *a, const float *b, float weight, int n);

    /** Pyramid: means of 2x2; upper and lower, which may be the same, are rows of 2 n values. */
    void (*halve)(const float *upper, const float *lower, float *to, int n);

    /** Weighted means, weights >= 0; 0 where all four weights are 0. */
    void (*halve_weighted)(const float *upper, const float *lower, const float *upper_weight,
                           const float *lower_weight, float *to, int n);

    /** Distance: near[i] = y where seed[i] >= 0, else above[i], or -1 if above is NULL. */
    void (*near_above)(const int32_t *seed, const int16_t *above, int y, int16_t *near, int n);

    /** near[i] is the nearest seed row at or above y, or -1: takes below[i] > y if that is nearer.
     */
    void (*near_below)(const int16_t *below, int y, int16_t *near, int n);

    /** Squared distances to the contour: from the best of a pixel's piece and those of its four
     * neighbours along links, as long as it gets nearer. */
    void (*to_contour)(const FlContourRow *row, float *squared, int n);

    /** Composite: straight RGBA over the sums of fl_layers_compose(), each level times 257. */
    void (*over)(const uint32_t *rgba, const FlSums *sums, int n);

    /** The RGBA of opaque sums, each value 257 times a level. */
    void (*level_opaque)(const FlSums *sums, uint32_t *rgba, int n);

    /** Composite, from the top down: sets the stored alpha of a layer; adds its paint and its
     * knock-out to the sums of the upper layers. */
    void (*occlude)(const FlOcclusion *layer, uint32_t *rgba, uint16_t *paint, uint8_t *area,
                    int n);

    /** Paper: values[i] *= factor[i] / 32768, rounded, at most 255. */
    void (*multiply)(const uint16_t *factor, uint8_t *values, int n);

    const char *name; // "c", "avx2", …
    unsigned flags;   // of the instruction set that it needs
} FlRowKernels;

/** The fastest version that flags allow; a pure function of them. */
const FlRowKernels *fl_row_kernels_for(unsigned flags);

/** The version for this processor. */
const FlRowKernels *fl_row_kernels(void);

/**
 * Defines the static function `name`: it runs the inline function `of` as it is compiled for this
 * processor. Both have these parameters, and the arguments are their names, each in parentheses.
 * It is for loops over pixels in one file; those of several files are in the table above.
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
        const unsigned flags = fl_row_kernels()->flags;                                            \
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

extern const FlRowKernels fl_row_kernels_c, fl_row_kernels_avx2, fl_row_kernels_avx512;
