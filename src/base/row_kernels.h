/* Loops over rows of pixels, compiled once per instruction set. */
#ifndef FLUIDY_BASE_ROW_KERNELS_H
#define FLUIDY_BASE_ROW_KERNELS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** What the processor can do; a level includes those below it. */
enum {
    FL_CPU_AVX2 = 1,
    FL_CPU_AVX512 = 2,
    FL_CPU_NEON = 4,
};

/** The processor's flags, lowered by the number in $FLUIDY_CPU_MASK. */
unsigned fl_cpu_flags(void);

/** Pixels being blended, in planes: values 0..65535 times alpha 0..255, and 65535 times alpha. */
typedef struct FlSums {
    uint32_t *x[3], *a;
} FlSums;

/** A row of a layer among those above it, for fl_layers_resolve(). */
typedef struct FlOcclusion {
    const uint8_t *coverage; // of the whole shape, 0..255
    const uint8_t *seen;     // the part of each pixel that belongs to it, 0..255
    const uint8_t *knockout; // of its paint, 0..255; NULL: 255
    int alpha;               // opacity of the layer, 0..255
    bool knocks;             // whether it takes anything
} FlOcclusion;

/** Every other cell of a row of a grid in which something diffuses, and what is around them. */
typedef struct FlStencil {
    float *value;
    const float *beside; // beside[i] is the value left of cell i, beside[i + 1] the one right of it
    const float *above, *below;
    const float *source;  // what flows in from elsewhere
    const float *inverse; // 1 / number of neighbours; 0 in a cell that keeps its value
} FlStencil;

/**
 * One version of every loop; all give the same bytes. The source is the same, too, for the compiler
 * knows the instruction sets: rows.inc. n is the length of what is written, 0 or more. Arrays
 * may be aligned anyhow and do not overlap.
 */
typedef struct FlRowKernels {
    /** Blur: to[i] += weight * (a[i] + b[i]). a and b may be the same. */
    void (*add_pair)(float *to, const float *a, const float *b, float weight, int n);

    /** Pyramid: means of 2x2; upper and lower, which may be the same, are rows of 2 n values. */
    void (*halve)(const float *upper, const float *lower, float *to, int n);

    /** The same of values that count by their weights, 0 or more; 0 where all of these are 0. */
    void (*halve_weighted)(const float *upper, const float *lower, const float *upper_weight,
                           const float *lower_weight, float *to, int n);

    /** Distance: near[i] = y where seed[i] >= 0, else above[i], or -1 if above is NULL. */
    void (*near_above)(const int32_t *seed, const int16_t *above, int y, int16_t *near, int n);

    /** Replaces rows near[i], the nearest to y at or above it or -1, by below[i] > y if nearer. */
    void (*near_below)(const int16_t *below, int y, int16_t *near, int n);

    /** Diffusion: value = (sum of the neighbours' values + source) * inverse. */
    void (*relax)(const FlStencil *cells, int n);

    /** Adds what 2 n cells are short of that to even[i / 2] and odd[i / 2] in turn. */
    void (*add_residual)(const FlStencil *cells, float *even, float *odd, int n);

    /**
     * Adds to 2 n values the mean of those around them on a coarser level, 9 : 3 : 3 : 1, which are
     * 0 where they have no part in the weight; not where it is 0. Around value[2 i] are the values
     * coarse[parents[0][…] + i], around value[2 i + 1] those of parents[1].
     */
    void (*refine)(const float *coarse, const size_t parents[2][4], const float *weight,
                   float *value, int n);

    /** Colourise: rgba[i] = look[amount[i]], as 32 bits; 0 where the amount is negative. */
    void (*look_up)(const int16_t *amount, const uint32_t *look, uint32_t *rgba, int n);

    /** Composite: straight RGBA over sums, as of fl_layers_compose(); a level's value is 257 times
     * it. */
    void (*over)(const uint8_t *rgba, const FlSums *sums, int n);

    /** The RGBA of sums that are opaque, each value being 257 times a level. */
    void (*level_opaque)(const FlSums *sums, uint8_t *rgba, int n);

    /** Enlarge: to[i] = sum[i] / weight[i], rounded; a weight below 1 counts as 1. */
    void (*share)(const float *sum, const float *weight, uint8_t *to, int n);

    /** Straight RGBA of sums of colour times alpha, and of alpha, the latter by its weight. */
    void (*straighten)(const float *const rgb[3], const float *alpha, const float *weight,
                       uint8_t *rgba, int n);

    /** Composite: what a layer shows of its paint, in place, and takes of what lies below it. */
    void (*occlude)(const FlOcclusion *layer, uint32_t *rgba, uint16_t *paint, uint8_t *area,
                    int n);

    const char *name; // "c", "avx2", …
} FlRowKernels;

/** The fastest version that flags allow; a pure function of them. */
const FlRowKernels *fl_row_kernels_for(unsigned flags);

/** That of this processor. */
const FlRowKernels *fl_row_kernels(void);

extern const FlRowKernels fl_row_kernels_c, fl_row_kernels_avx2, fl_row_kernels_avx512;

#endif
