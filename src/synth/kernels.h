/* The inner loop of the search, once in C and once per instruction set. */
#ifndef FLUIDY_SYNTH_KERNELS_H
#define FLUIDY_SYNTH_KERNELS_H

#include "synth/rotation.h"
#include "synth/spline.h"
#include <stddef.h>

/** Channels of a pixel, in the exemplar and in the target. */
enum {
    FL_CH_R,
    FL_CH_G,
    FL_CH_B,        // 0 … FL_ONE
    FL_CH_SHAPE,    // 0 … FL_ONE
    FL_CH_EXT_PLUS, // FL_ONE is twice the source's maximum
    FL_CH_EXT_MINUS,
    FL_CH_ANGLE,   // direction of the flow, 256 steps; weight 0
    FL_CH_SEGMENT, // FlSegment; weight 0
    FL_CHANNELS
};

#define FL_TEXEL_ONE 255                // 1.0 in the exemplar
#define FL_FINE 16                      // steps of the target per step of the exemplar
#define FL_ONE (FL_TEXEL_ONE * FL_FINE) // 1.0 in the target

/** A pixel of the exemplar: as small as can be, since the search is bound by fetching them. */
typedef struct FlTexel {
    uint8_t c[FL_CHANNELS];
} FlTexel;

/** A pixel of the target. */
typedef struct FlPacked {
    int16_t c[FL_CHANNELS];
} FlPacked;

/**
 * Weighted squared distance of a rotated exemplar patch to a target patch.
 *
 * centre points at the exemplar pixel; offsets are the rotated patch's, in pixels, in the order of
 * fl_patch_offsets. target and weight hold FL_PATCH_PIXELS packed pixels in that order, 64-byte
 * aligned; channels are 0 … FL_ONE and weights 0 … 32767 for 0 … 1. A difference d is weighted as
 * d * round(d * w / 32768); 25 * 8 * FL_ONE^2 < 2^32, so the sum cannot overflow.
 *
 * Returns: the distance; or, once it exceeds limit, any number above limit.
 */
typedef uint32_t (*FlPatchDistance)(const FlTexel *centre, const int32_t *offsets,
                                    const FlPacked *target, const FlPacked *weight, uint32_t limit);

/**
 * The value of a spline between 4x4 coefficients, the first of which is given, with rows of `pitch`
 * pixels: value[c] = sum over rows j, in order, of y[j] * (the whole sum of x[i] * coefficient). x
 * and y as in FlSplinePhase. Every version rounds alike.
 */
typedef void (*FlSplineSample)(const FlSplinePixel *first, size_t pitch, const int16_t *x,
                               const float *y, float value[4]);

#define FL_SAME_PLACE 12 // 1/16 px: votes nearer than that mean the same place
#define FL_VOTE_BIAS 64  // added to places, so that none is negative

/** The places that the patches over a pixel point to, in 1/16 px; frame -1: no patch. */
typedef struct FlVotes {
    _Alignas(64) uint16_t x[32];
    _Alignas(64) uint16_t y[32];
    _Alignas(64) int16_t frame[32]; // the first FL_PATCH_PIXELS of each count
} FlVotes;

/** Votes for the same place: the first of them, and the others' differences from it. */
typedef struct FlOpinion {
    int x, y, frame;
    int sum_x, sum_y;
    int n; // of votes, the first included
} FlOpinion;

/**
 * Sorts votes into opinions: the first vote that is left leads, all that are left in its frame and
 * near it join. opinions has room for FL_PATCH_PIXELS. Returns their number.
 */
typedef int (*FlFindOpinions)(const FlVotes *votes, FlOpinion *opinions);

/** One version of every kernel. */
typedef struct FlKernels {
    FlPatchDistance patch_distance;
    FlSplineSample spline_sample;
    FlFindOpinions opinions;
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

uint32_t fl_patch_distance_c(const FlTexel *centre, const int32_t *offsets, const FlPacked *target,
                             const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_avx2(const FlTexel *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_avx512(const FlTexel *centre, const int32_t *offsets,
                                  const FlPacked *target, const FlPacked *weight, uint32_t limit);
uint32_t fl_patch_distance_neon(const FlTexel *centre, const int32_t *offsets,
                                const FlPacked *target, const FlPacked *weight, uint32_t limit);

void fl_spline_sample_c(const FlSplinePixel *first, size_t pitch, const int16_t *x, const float *y,
                        float value[4]);
void fl_spline_sample_avx2(const FlSplinePixel *first, size_t pitch, const int16_t *x,
                           const float *y, float value[4]);

int fl_find_opinions_c(const FlVotes *votes, FlOpinion *opinions);
int fl_find_opinions_avx2(const FlVotes *votes, FlOpinion *opinions);
int fl_find_opinions_avx512(const FlVotes *votes, FlOpinion *opinions);

#endif
