/* The inner loops of search and vote, once in C and once per instruction set. */
#pragma once

#include "base/cpu.h"
#include "synth/fluid_texel.h"
#include "synth/rotation.h"
#include "synth/spline.h"
#include <stdbool.h>
#include <stddef.h>

/** Channels of a pixel, in the exemplar and in the target. */
enum {
    FL_CH_R,
    FL_CH_G,
    FL_CH_B,        // 0 … FL_ONE
    FL_CH_SHAPE,    // 0 … FL_ONE
    FL_CH_EXT_PLUS, // FL_ONE is twice the source's maximum
    FL_CH_EXT_MINUS,
    FL_WEIGHED_CHANNELS,
    FL_CH_ANGLE = FL_WEIGHED_CHANNELS, // direction of the flow, 256 steps
    FL_CH_SEGMENT,                     // FlSegment
    FL_CHANNELS,
    FL_CH_COLOUR_WEIGHT = FL_CH_ANGLE // of a target
};

#define FL_TEXEL_ONE 255                // 1.0 in the exemplar
#define FL_FINE 16                      // steps of the target per step of the exemplar
#define FL_ONE (FL_TEXEL_ONE * FL_FINE) // 1.0 in the target

/** A pixel of the exemplar: small, since the search is bound by fetching them. */
typedef struct FlTexel {
    uint8_t c[FL_CHANNELS];
} FlTexel;

/** A pixel of the target. */
typedef struct FlTargetTexel {
    int16_t c[FL_CHANNELS];
} FlTargetTexel;

/**
 * Weighted squared distance of a rotated exemplar patch to a target patch.
 *
 * centre points at the exemplar pixel; offsets are the rotated patch's, in pixels, in the order of
 * fl_patch_offsets. Where the patch is `opposed`, its extents change places. target holds
 * FL_PATCH_PIXELS pixels in that order, 64-byte aligned; channels are 0 … FL_ONE and weights
 * 0 … 32767 for 0 … 1. The colours' weight is each pixel's own, the other channels' are in `rest`.
 * A difference d is weighted as d * round(d * w / 32768); 25 * 6 * FL_ONE^2 < 2^32, so the sum
 * cannot overflow.
 *
 * Returns: the distance; or, once it exceeds limit, any number above limit.
 */
typedef uint32_t (*FlPatchDistance)(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                    const FlTargetTexel *target, const FlTargetTexel *rest,
                                    uint32_t limit);

/**
 * The distances of a patch, and of the patch turned by another half turn and opposed, which
 * consists of the same texels: offsets[p ^ 1] is -offsets[p], the last is 0. A distance may be any
 * number above limit where it exceeds limit.
 */
typedef void (*FlPatchPair)(const FlTexel *centre, const int16_t *offsets,
                            const FlTargetTexel *target, const FlTargetTexel *rest, uint32_t limit,
                            uint32_t distance[2]);

#define FL_MAX_CANDIDATES 64 // of the random search for one pixel

/** The windows of random candidates; frames count from the first that is searched. */
typedef struct FlSearchWindows {
    _Alignas(64) uint16_t reach[3][FL_MAX_CANDIDATES]; // from the centre: x, y (px), frames
    uint16_t size[3];                                  // of what is searched: x, y, frames
    uint32_t step[3]; // pixels from one column, row, frame to the next in memory
    int n;            // windows
} FlSearchWindows;

/** Random candidates; only the first n of the windows count. */
typedef struct FlCandidates {
    _Alignas(64) uint16_t at[3][FL_MAX_CANDIDATES]; // x, y, frame
    uint32_t pixel[FL_MAX_CANDIDATES]; // index in memory from the first frame's first pixel
} FlCandidates;

/** Draws a try from each window around a centre (x, y, frame); the key decides. */
void fl_draw_candidates(const FlSearchWindows *windows, const uint16_t centre[3], uint32_t key,
                        FlCandidates *candidates);

/** The tests that a try must pass before its patch is compared. */
typedef struct FlCandidateFilter {
    const FlTexel *first; // the first frame's first pixel
    uint8_t segment;      // the segment of a try's centre
    const int32_t *use;   // the occurrence map of the segment
    uint32_t step[3];     // of the map: cells from one column, row, slice to the next
    uint16_t factor[3];   // a place p, in x, y and time, is in cell (2p + 1) * factor >> 16
    uint16_t own[3];      // the cell whose use is the pixel's own
    float price, most;    // of one use, and of all
    uint32_t limit;       // a try must cost less,
    int16_t frames[4];    // unless it is in one of these frames
} FlCandidateFilter;

/**
 * Filters the first n candidates. Returns: a bit for each that passes. uniformity: the terms of the
 * candidates that pass, the price times the use of their cell without the pixel's own use, which
 * the tent spreads over 27 cells. Places are below 32768. fl_draw_candidates() must have drawn the
 * candidates, and a few more than n.
 */
uint64_t fl_filter_candidates(const FlCandidates *candidates, int n,
                              const FlCandidateFilter *filter, uint32_t *uniformity);

/**
 * The value of a spline between 4x4 coefficients, the first of which is given, with rows of `pitch`
 * pixels: value[c] = sum over rows j, in order, of y[j] * (the whole sum of x[i] * coefficient). x
 * and y as in FlSplinePhase. Every version rounds alike.
 */
typedef void (*FlSplineSample)(const FlSplinePixel *first, size_t pitch, const int16_t *x,
                               const float *y, float value[4]);

#define FL_SAME_PLACE 12 // 1/16 px: votes nearer than that mean the same place
#define FL_VOTE_BIAS 64  // added to places, to keep them from being negative
#define FL_VOTES 32      // numbers that are read of 25

/** The FL_PATCH_PIXELS matches around a pixel, column by column; FL_VOTES can be read of each. */
typedef struct FlVoteMatches {
    const uint16_t *x, *y;    // of the match, in 1/16 px, with FL_VOTE_BIAS
    const int16_t *frame;     // -1: no match
    const int16_t (*turn)[2]; // fl_turns of its rotation
} FlVoteMatches;

/** The source of the votes' samples. */
typedef struct FlVoteSource {
    const FlSplinePixel *colour;       // pixel (-1, -1) of frame 0
    size_t pitch, frame_pixels;        // pixels from one row, frame to the next
    int most[2];                       // the last column and row, 1/16 px
    float weight[FL_PATCH_PIXELS + 1]; // of a cluster of so many votes
} FlVoteSource;

/** Factors of the cosine and sine of a match's turn. The sum of both products is the x or y of its
 * vote, relative to the match: the offset to the middle. [axis], in the order of FlVoteMatches,
 * zeros at the end. */
extern const int16_t fl_vote_steps[2][FL_VOTES][2];

/** The places that the patches over a pixel point to, in 1/16 px, in that order; frame -1: no
 * match. */
typedef struct FlVotes {
    _Alignas(64) uint16_t x[FL_VOTES];
    _Alignas(64) uint16_t y[FL_VOTES];
    _Alignas(64) int16_t frame[FL_VOTES]; // the first FL_PATCH_PIXELS of each count
} FlVotes;

/** The first, row by row, of the votes whose bits are set. */
static inline int fl_vote_leader(uint32_t left)
{
    uint32_t row = 0x108421; // the first of each column
    while (!(left & row))
        row <<= 1;
    return __builtin_ctz(left & row);
}

/** Votes that agree on a place: the first, and the sum of (other - first) over the others. */
typedef struct FlVoteCluster {
    int x, y, frame;
    int sum_x, sum_y;
    uint32_t votes; // a bit for each, the first included
} FlVoteCluster;

/**
 * The colour of a pixel that patches cover: the mean of their clusters, weighted, each of which is
 * sampled at the mean of its places, rounded away from the first. Every version rounds alike.
 *
 * Returns: false without any patch; colour is then undefined.
 */
typedef bool (*FlVote)(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4]);

/**
 * The same for the four pixels, row by row, that a pixel is in twice the size, which `voted` has.
 * All patches over the pixel vote, each for the same part of its match as in the search.
 */
typedef bool (*FlVoteDoubled)(const FlVoteMatches *covering, const FlVoteSource *voted,
                              float colour[4][4]);

#define FL_OFF_ONE 8

/** NNF(q): the centre of the source patch in 1/16 px of its level, its frame, its rotation. */
typedef struct FlMatch {
    uint16_t x_16, y_16;
    int16_t frame; // FL_NO_MATCH: no match
    uint8_t theta; // target offset o is source offset R(-theta) o
    uint8_t off;   // from the pixel to its paint: x + 16 y, each -8 … 7 of FL_OFF_ONE a px
} FlMatch;

#define FL_NO_MATCH -1

/** One version of every kernel. */
typedef struct FlKernels {
    FlPatchDistance patch_distance;
    FlPatchPair patch_pair;
    FlSplineSample spline_sample;
    FlVote vote;
    FlVoteDoubled vote_doubled;
    FlFluidDistance fluid_distance;
    const char *name; // "c", "avx2", …
} FlKernels;

/** Chooses the fastest version that flags allow; a pure function of them. */
void fl_kernels_init(FlKernels *kernels, unsigned flags);

uint32_t fl_patch_distance_c(const FlTexel *centre, const int16_t *offsets, bool opposed,
                             const FlTargetTexel *target, const FlTargetTexel *rest,
                             uint32_t limit);
uint32_t fl_patch_distance_avx2(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                const FlTargetTexel *target, const FlTargetTexel *rest,
                                uint32_t limit);
uint32_t fl_patch_distance_neon(const FlTexel *centre, const int16_t *offsets, bool opposed,
                                const FlTargetTexel *target, const FlTargetTexel *rest,
                                uint32_t limit);

void fl_patch_pair_avx2(const FlTexel *centre, const int16_t *offsets, const FlTargetTexel *target,
                        const FlTargetTexel *rest, uint32_t limit, uint32_t distance[2]);

void fl_spline_sample_c(const FlSplinePixel *first, size_t pitch, const int16_t *x, const float *y,
                        float value[4]);
void fl_spline_sample_avx2(const FlSplinePixel *first, size_t pitch, const int16_t *x,
                           const float *y, float value[4]);

bool fl_vote_c(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4]);
bool fl_vote_avx2(const FlVoteMatches *covering, const FlVoteSource *voted, float colour[4]);

bool fl_vote_doubled_c(const FlVoteMatches *covering, const FlVoteSource *voted,
                       float colour[4][4]);
bool fl_vote_doubled_avx2(const FlVoteMatches *covering, const FlVoteSource *voted,
                          float colour[4][4]);
