/* The inner loop of the search, once in C and once per instruction set. */
#ifndef FLUIDY_SYNTH_KERNELS_H
#define FLUIDY_SYNTH_KERNELS_H

#include "synth/rotation.h"

/** Channels of a packed pixel: one 16-byte load. */
enum {
    FL_CH_R,
    FL_CH_G,
    FL_CH_B,        // 0 … FL_ONE
    FL_CH_SHAPE,    // 0 … FL_ONE
    FL_CH_EXT_PLUS, // in source maxima, 0 … 2 FL_ONE
    FL_CH_EXT_MINUS,
    FL_CH_ANGLE,   // direction of the flow, 0 … 255; weight 0
    FL_CH_SEGMENT, // FlSegment; weight 0
    FL_CHANNELS
};

#define FL_ONE 1020 // 1.0 in a packed channel: four times an 8-bit level

/** A packed pixel. */
typedef struct FlPacked {
    int16_t c[FL_CHANNELS];
} FlPacked;

/**
 * Weighted squared distance of a rotated exemplar patch to a target patch.
 *
 * centre points at the packed exemplar pixel; offsets are the rotated patch's, in pixels, in the
 * order of fl_patch_offsets. target and weight hold FL_PATCH_PIXELS packed pixels in that order,
 * 16-byte aligned; weights are 0 … 32767 for 0 … 1. Differences d are weighted as
 * d * round(d * w / 32768), which sums to less than 2^31 for channels within 0 … 2 FL_ONE.
 *
 * Returns: the distance; or, once it exceeds limit, any number above limit.
 */
typedef uint32_t (*FlPatchDistance)(const FlPacked *centre, const int32_t *offsets,
                                    const FlPacked *target, const FlPacked *weight, uint32_t limit);

/** One version of every kernel. */
typedef struct FlKernels {
    FlPatchDistance patch_distance;
    const char *name; // "c", "avx2", …
} FlKernels;

/** What the processor can do; a level includes those below it. */
enum {
    FL_CPU_AVX2 = 1,
    FL_CPU_AVX512 = 2,
    FL_CPU_NEON = 4,
};

/** The processor's flags, lowered by the number in $FLUIDY_CPU_MASK. */
unsigned fl_cpu_flags(void);

/** Chooses the fastest version that flags allow; a pure function of them. */
void fl_kernels_init(FlKernels *kernels, unsigned flags);

uint32_t fl_patch_distance_c(const FlPacked *centre, const int32_t *offsets, const FlPacked *target,
                             const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_avx2(const FlPacked *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_avx512(const FlPacked *centre, const int32_t *offsets,
                                  const FlPacked *target, const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_neon(const FlPacked *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit);

#endif
