#include "synth/kernels.h"

#include "base/rng.h"
#include "config.h"
#include <glib.h>
#include <stdlib.h>

/* One pixel's share of a distance. */
static uint32_t term(const FlTexel *source, bool opposed, const FlCompressed *target,
                     const FlCompressed *rest)
{
    FlTexel s = *source;
    if (opposed) {
        s.c[FL_CH_EXT_PLUS] = source->c[FL_CH_EXT_MINUS];
        s.c[FL_CH_EXT_MINUS] = source->c[FL_CH_EXT_PLUS];
    }
    uint32_t sum = 0;
    for (int c = 0; c < FL_WEIGHED_CHANNELS; c++) {
        const int d = FL_FINE * s.c[c] - target->c[c];
        const int weight = c <= FL_CH_B ? target->c[FL_CH_COLOUR_WEIGHT] : rest->c[c];
        sum += (uint32_t)(d * ((d * weight + (1 << 14)) >> 15));
    }
    return sum;
}

uint32_t fl_patch_distance_c(const FlTexel *centre, const int16_t *offsets, bool opposed,
                             const FlCompressed *target, const FlCompressed *rest, uint32_t limit)
{
    uint32_t sum = 0;
    for (int p = 0; p < FL_PATCH_PIXELS && sum <= limit; p++)
        sum += term(centre + offsets[p], opposed, &target[p], rest);
    return sum;
}

static void patch_pair_c(const FlTexel *centre, const int16_t *offsets, const FlCompressed *target,
                         const FlCompressed *rest, uint32_t limit, uint32_t distance[2])
{
    distance[0] = fl_patch_distance_c(centre, offsets, false, target, rest, limit);
    distance[1] = 0;
    for (int p = 0; p < FL_PATCH_PIXELS && distance[1] <= limit; p++)
        distance[1] += term(centre - offsets[p], true, &target[p], rest);
}

void fl_draw_tries_c(const FlWindows *windows, const uint16_t centre[3], uint32_t key,
                     FlTries *tries)
{
    for (int k = 0; k < windows->n; k++) {
        tries->pixel[k] = 0;
        for (int axis = 0; axis < 3; axis++) {
            const int reach = windows->reach[axis][k], last = windows->size[axis] - 1;
            const int low = MAX(centre[axis] - reach, 0), high = MIN(centre[axis] + reach, last);
            const uint32_t place = (uint32_t)(axis * FL_MAX_TRIES + k) / 2; // 16 bits for each try
            const uint32_t bits = fl_hash32(key + place * FL_HASH32_STEP) >> (k % 2 * 16) & 0xffff;
            const uint32_t at = (uint32_t)low + (bits * (uint32_t)(high - low + 1) >> 16);
            tries->at[axis][k] = (uint16_t)at;
            tries->pixel[k] += at * windows->step[axis];
        }
    }
}

/* How much of a match's use a cell so many cells away gets. */
static int share(int apart)
{
    return MAX(2 - abs(apart), 0);
}

static uint32_t uniformity_of(const FlTries *tries, int k, const FlSieve *sieve)
{
    uint32_t index = 0;
    int own = 1;
    for (int axis = 0; axis < 3; axis++) {
        const uint32_t cell = (2u * tries->at[axis][k] + 1) * sieve->factor[axis] >> 16;
        index += cell * sieve->step[axis];
        own *= share((int)cell - sieve->own[axis]);
    }
    const int use = sieve->use[index] - own;
    return (uint32_t)MIN((float)MAX(use, 0) * sieve->price, sieve->most);
}

uint64_t fl_sift_c(const FlTries *tries, int n, const FlSieve *sieve, uint32_t *uniformity)
{
    uint64_t passed = 0;
    for (int k = 0; k < n; k++) {
        const int16_t frame = (int16_t)tries->at[2][k], *frames = sieve->frames;
        if (sieve->first[tries->pixel[k]].c[FL_CH_SEGMENT] != sieve->segment)
            continue;
        uniformity[k] = uniformity_of(tries, k, sieve);
        if (uniformity[k] < sieve->limit || frame == frames[0] || frame == frames[1] ||
            frame == frames[2] || frame == frames[3])
            passed |= 1ull << k;
    }
    return passed;
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
    opinion->votes |= 1u << k;
}

static int find_opinions_c(const FlVotes *votes, FlOpinion *opinions)
{
    int n = 0;
    uint32_t left = 0;
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        left |= (uint32_t)(votes->frame[k] >= 0) << k;
    while (left) {
        const int leader = fl_vote_leader(left);
        FlOpinion *o = &opinions[n++];
        *o = (FlOpinion){
            .x = votes->x[leader], .y = votes->y[leader], .frame = votes->frame[leader]};
        for (int k = 0; k < FL_PATCH_PIXELS; k++)
            if (left >> k & 1 && votes->frame[k] == o->frame &&
                is_near(votes->x[k], votes->x[leader]) && is_near(votes->y[k], votes->y[leader])) {
                join(votes, k, o);
                left &= ~(1u << k);
            }
    }
    return n;
}

#define COLUMN_X(dx)                                                                               \
    {dx, 2}, {dx, 1}, {dx, 0}, {dx, -1},                                                           \
    {                                                                                              \
        dx, -2                                                                                     \
    }
#define COLUMN_Y(dx)                                                                               \
    {2, -(dx)}, {1, -(dx)}, {0, -(dx)}, {-1, -(dx)},                                               \
    {                                                                                              \
        -2, -(dx)                                                                                  \
    }
_Alignas(64) const int16_t fl_vote_steps[2][FL_VOTES][2] = {
    {COLUMN_X(2), COLUMN_X(1), COLUMN_X(0), COLUMN_X(-1), COLUMN_X(-2)},
    {COLUMN_Y(2), COLUMN_Y(1), COLUMN_Y(0), COLUMN_Y(-1), COLUMN_Y(-2)}};

static int offset_along(const int16_t turn[2], const int16_t step[2])
{
    return (turn[0] * step[0] + turn[1] * step[1] + (1 << 9)) >> 10;
}

static void find_places(const FlCovering *covering, FlVotes *votes)
{
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int16_t *turn = covering->turn[k];
        votes->x[k] = (uint16_t)(covering->x[k] + offset_along(turn, fl_vote_steps[0][k]));
        votes->y[k] = (uint16_t)(covering->y[k] + offset_along(turn, fl_vote_steps[1][k]));
        votes->frame[k] = covering->frame[k];
    }
}

/* The mean of first + sum / n over the n votes, half away from first. */
static int mean_of(int first, int sum, uint32_t votes)
{
    const int n = __builtin_popcount(votes);
    return first - FL_VOTE_BIAS + (sum + (sum < 0 ? -n : n) / 2) / n;
}

/* The weighted sum of what opinions say. */
typedef struct Sum {
    float value[4], weight;
} Sum;

/* What an opinion of n votes says, whose place may lie beyond the borders. */
static void add_opinion(Sum *sum, const FlOpinion *opinion, int n, int x, int y,
                        FlSplineSample sample, const FlVoted *voted)
{
    float value[4];
    x = CLAMP(x, 0, voted->most[0]), y = CLAMP(y, 0, voted->most[1]);
    sample(voted->colour + (size_t)opinion->frame * voted->frame_pixels +
               (size_t)(y >> 4) * voted->pitch + (x >> 4),
           voted->pitch, fl_spline_phases[x & 15].x, fl_spline_phases[y & 15].y, value);
    for (int c = 0; c < 4; c++)
        sum->value[c] += voted->weight[n] * value[c];
    sum->weight += voted->weight[n];
}

static void colour_of(const Sum *sum, float colour[4])
{
    for (int c = 0; c < 4; c++)
        colour[c] = CLAMP(sum->value[c] / sum->weight, 0.0f, 1.0f);
}

bool fl_vote_of(const FlVotes *votes, FlFindOpinions find_opinions, FlSplineSample sample,
                const FlVoted *voted, float colour[4])
{
    FlOpinion opinions[FL_PATCH_PIXELS];
    Sum sum = {0};
    const int n = find_opinions(votes, opinions);
    for (const FlOpinion *o = opinions; o < opinions + n; o++)
        add_opinion(&sum, o, __builtin_popcount(o->votes), mean_of(o->x, o->sum_x, o->votes),
                    mean_of(o->y, o->sum_y, o->votes), sample, voted);
    colour_of(&sum, colour);
    return n > 0;
}

/* Votes are column by column: child % 2 is along lines. */
static void add_children(Sum sum[4], const FlOpinion *opinion, const int16_t turn[2],
                         FlSplineSample sample, const FlVoted *voted)
{
    const int x = mean_of(opinion->x, opinion->sum_x, opinion->votes);
    const int y = mean_of(opinion->y, opinion->sum_y, opinion->votes);
    for (int child = 0; child < 4; child++) {
        const FlOffset move = fl_child_move(turn, child % 2, child / 2);
        const int n =
            fl_votes_doubled(opinion->votes, FL_LINES_TWICE(child % 2), FL_PLACES_TWICE(child / 2));
        add_opinion(&sum[child], opinion, n, x + move.x, y + move.y, sample, voted);
    }
}

bool fl_vote_doubled_of(FlVotes *votes, const int16_t (*turn)[2], FlFindOpinions find_opinions,
                        FlSplineSample sample, const FlVoted *voted, float colour[4][4])
{
    FlOpinion opinions[FL_PATCH_PIXELS];
    Sum sum[4] = {0};
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        votes->x[k] = (uint16_t)(2 * votes->x[k] - FL_VOTE_BIAS);
        votes->y[k] = (uint16_t)(2 * votes->y[k] - FL_VOTE_BIAS);
        if (!(FL_VOTES_BESIDE >> k & 1))
            votes->frame[k] = FL_NO_MATCH;
    }
    const int n = find_opinions(votes, opinions);
    for (const FlOpinion *o = opinions; o < opinions + n; o++)
        add_children(sum, o, turn[fl_vote_leader(o->votes)], sample, voted);
    for (int child = 0; child < 4; child++)
        colour_of(&sum[child], colour[child]);
    return n > 0;
}

bool fl_vote_c(const FlCovering *covering, const FlVoted *voted, float colour[4])
{
    FlVotes votes;
    find_places(covering, &votes);
    return fl_vote_of(&votes, find_opinions_c, fl_spline_sample_c, voted, colour);
}

bool fl_vote_doubled_c(const FlCovering *covering, const FlVoted *voted, float colour[4][4])
{
    FlVotes votes;
    find_places(covering, &votes);
    return fl_vote_doubled_of(&votes, covering->turn, find_opinions_c, fl_spline_sample_c, voted,
                              colour);
}

void fl_upscale_row_c(const FlMatch *coarse, const FlOffset (*moves)[2], const uint16_t most[2],
                      FlMatch *fine, int n)
{
    for (int i = 0; i < n; i++) {
        FlMatch m = coarse[i / 2];
        const FlOffset move = moves[m.theta][i % 2];
        m.x_16 = (uint16_t)CLAMP(2 * m.x_16 + move.x, 0, most[0]);
        m.y_16 = (uint16_t)CLAMP(2 * m.y_16 + move.y, 0, most[1]);
        fine[i] = m;
    }
}

void fl_kernels_init(FlKernels *kernels, unsigned flags)
{
    *kernels = (FlKernels){fl_patch_distance_c, patch_pair_c, fl_draw_tries_c,   fl_sift_c,
                           fl_spline_sample_c,  fl_vote_c,    fl_vote_doubled_c, fl_upscale_row_c,
                           fl_fluid_distance_c, "c"};
#if HAVE_NEON
    if (flags & FL_CPU_NEON) {
        kernels->patch_distance = fl_patch_distance_neon;
        kernels->name = "neon";
    }
#endif
#if HAVE_AVX2
    if (flags & FL_CPU_AVX2)
        *kernels = (FlKernels){fl_patch_distance_avx2, fl_patch_pair_avx2,
                               fl_draw_tries_avx2,     fl_sift_avx2,
                               fl_spline_sample_avx2,  fl_vote_avx2,
                               fl_vote_doubled_avx2,   fl_upscale_row_avx2,
                               fl_fluid_distance_avx2, "avx2"};
#endif
#if HAVE_AVX512
    if (flags & FL_CPU_AVX512) {
        kernels->patch_distance = fl_patch_distance_avx512;
        kernels->patch_pair = fl_patch_pair_avx512;
        kernels->draw_tries = fl_draw_tries_avx512;
        kernels->sift = fl_sift_avx512;
        kernels->vote = fl_vote_avx512;
        kernels->vote_doubled = fl_vote_doubled_avx512;
        kernels->upscale_row = fl_upscale_row_avx512;
        kernels->name = "avx512";
    }
#endif
}
