/*
 * Every version of every kernel against C: exact equality on noise and on overflow bait.
 *
 * With --time as the only argument, no test: prints nanoseconds per call on data that is in the
 * cache, which the search's is not; bench tells what a version is worth there.
 */
#include "base/rng.h"
#include "synth/kernels.h"
#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

#define FIELD 64 // side of the exemplar that is sampled

typedef struct Case {
    FlTexel source[FIELD * FIELD];
    _Alignas(64) FlTargetTexel target[FL_PATCH_PIXELS + 3];
    FlTargetTexel rest;
    int16_t offsets[FL_PATCH_PIXELS];
} Case;

static void fill(FlTargetTexel *pixels, int n, FlRng *rng, int limit)
{
    for (int p = 0; p < n; p++)
        for (int c = 0; c < FL_CHANNELS; c++)
            pixels[p].c[c] = (int16_t)fl_rng_below(rng, (uint32_t)limit + 1);
}

static void fill_texels(FlTexel *texels, int n, FlRng *rng)
{
    for (int p = 0; p < n; p++)
        for (int c = 0; c < FL_CHANNELS; c++)
            texels[p].c[c] = (uint8_t)fl_rng_u32(rng);
}

/* Offsets as of a rotated patch: opposite ones in pairs, the centre last. */
static void make_offsets(int16_t *offsets, FlRng *rng)
{
    for (int p = 0; p < FL_PATCH_PIXELS - 1; p += 2) {
        const int dx = (int)fl_rng_below(rng, 7) - 3, dy = (int)fl_rng_below(rng, 7) - 3;
        offsets[p] = (int16_t)(dy * FIELD + dx);
        offsets[p + 1] = (int16_t)-offsets[p];
    }
    offsets[FL_PATCH_PIXELS - 1] = 0;
}

static void make_case(Case *c, uint64_t seed)
{
    FlRng rng = {seed};
    fill_texels(c->source, FIELD * FIELD, &rng);
    fill(c->target, FL_PATCH_PIXELS, &rng, FL_ONE);
    for (int p = 0; p < FL_PATCH_PIXELS; p++)
        c->target[p].c[FL_CH_COLOUR_WEIGHT] = (int16_t)fl_rng_below(&rng, 32768);
    fill(&c->rest, 1, &rng, 32767);
    make_offsets(c->offsets, &rng);
}

/* Any pixel that its patch does not leave the field from. */
static const FlTexel *centre_of(const Case *c, uint64_t seed)
{
    return c->source + 4 * FIELD + seed % (FIELD * (FIELD - 8));
}

static const unsigned levels[] = {0, FL_CPU_AVX2, FL_CPU_AVX2 | FL_CPU_AVX512, FL_CPU_NEON};

/* A level that the processor lacks must not be run. */
static bool available(unsigned flags)
{
    return (fl_cpu_flags() & flags) == flags;
}

static uint32_t distance_c(const Case *c, const FlTexel *centre, bool opposed, uint32_t limit)
{
    return fl_patch_distance_c(centre, c->offsets, opposed, c->target, &c->rest, limit);
}

static void the_distance_is_that_of_c(const void *version)
{
    const FlKernels *kernels = version;
    for (uint64_t seed = 1; seed <= 2000; seed++) {
        Case c;
        make_case(&c, seed);
        const FlTexel *centre = centre_of(&c, seed);
        const uint32_t want = distance_c(&c, centre, seed % 2, UINT32_MAX);
        const uint32_t got =
            kernels->patch_distance(centre, c.offsets, seed % 2, c.target, &c.rest, UINT32_MAX);
        if (got != want)
            g_test_message("%s, seed %" G_GUINT64_FORMAT, kernels->name, seed);
        g_assert_cmpuint(got, ==, want);
    }
}

/* The exemplar all 0, the target all 1, every weight 1. */
static void nothing_overflows_on_extremes(const void *version)
{
    const FlKernels *kernels = version;
    Case c;
    make_case(&c, 1);
    memset(c.source, 0, sizeof c.source);
    for (int k = 0; k < FL_WEIGHED_CHANNELS; k++)
        c.rest.c[k] = 32767;
    for (int p = 0; p < FL_PATCH_PIXELS; p++) {
        for (int k = 0; k < FL_WEIGHED_CHANNELS; k++)
            c.target[p].c[k] = FL_ONE;
        c.target[p].c[FL_CH_COLOUR_WEIGHT] = 32767;
    }
    const FlTexel *centre = centre_of(&c, 0);
    const uint32_t whole = 25u * 6 * FL_ONE * FL_ONE;
    uint32_t pair[2];
    g_assert_cmpuint(
        kernels->patch_distance(centre, c.offsets, false, c.target, &c.rest, UINT32_MAX), ==,
        whole);
    kernels->patch_pair(centre, c.offsets, c.target, &c.rest, UINT32_MAX, pair);
    g_assert_cmpuint(pair[0], ==, whole);
    g_assert_cmpuint(pair[1], ==, whole);
}

static void a_limit_never_changes_which_side_of_it_a_distance_is_on(const void *version)
{
    const FlKernels *kernels = version;
    for (uint64_t seed = 1; seed <= 500; seed++) {
        Case c;
        make_case(&c, seed);
        const FlTexel *centre = centre_of(&c, seed);
        const uint32_t whole = distance_c(&c, centre, false, UINT32_MAX);
        const uint32_t at =
            kernels->patch_distance(centre, c.offsets, false, c.target, &c.rest, whole);
        const uint32_t below =
            kernels->patch_distance(centre, c.offsets, false, c.target, &c.rest, whole - 1);
        g_assert_cmpuint(at, ==, whole);
        g_assert_cmpuint(below, >, whole - 1);
    }
}

/* Offsets of the patch turned by half a turn. */
static void turn(const int16_t *offsets, int16_t *turned)
{
    for (int p = 0; p < FL_PATCH_PIXELS; p++)
        turned[p] = (int16_t)-offsets[p];
}

static void a_pair_is_the_distances_of_both_half_turns(const void *version)
{
    const FlKernels *kernels = version;
    for (uint64_t seed = 1; seed <= 1000; seed++) {
        Case c;
        int16_t turned[FL_PATCH_PIXELS];
        uint32_t got[2];
        make_case(&c, seed);
        turn(c.offsets, turned);
        const FlTexel *centre = centre_of(&c, seed);
        const uint32_t want[2] = {
            distance_c(&c, centre, false, UINT32_MAX),
            fl_patch_distance_c(centre, turned, true, c.target, &c.rest, UINT32_MAX)};
        kernels->patch_pair(centre, c.offsets, c.target, &c.rest, MAX(want[0], want[1]), got);
        g_assert_cmpuint(got[0], ==, want[0]);
        g_assert_cmpuint(got[1], ==, want[1]);
        const uint32_t limit = MIN(want[0], want[1]);
        kernels->patch_pair(centre, c.offsets, c.target, &c.rest, limit, got);
        g_assert_cmpuint(MIN(got[0], got[1]), ==, limit);
        kernels->patch_pair(centre, c.offsets, c.target, &c.rest, limit - 1, got);
        g_assert_cmpuint(MIN(got[0], got[1]), >, limit - 1);
    }
}

/* Windows of an exemplar of up to `most` pixels and frames a side. */
static void make_windows(FlSearchWindows *windows, uint32_t most, FlRng *rng)
{
    *windows = (FlSearchWindows){.n = 1 + (int)fl_rng_below(rng, FL_MAX_CANDIDATES)};
    windows->step[0] = 1;
    for (int axis = 0; axis < 3; axis++) {
        windows->size[axis] = (uint16_t)(1 + fl_rng_below(rng, most));
        for (int k = 0; k < windows->n; k++)
            windows->reach[axis][k] = (uint16_t)fl_rng_below(rng, most);
    }
    windows->step[1] = windows->size[0];
    windows->step[2] = (uint32_t)windows->size[0] * windows->size[1];
}

/* The place along an axis that 16 bits of the key choose within a window. */
static uint32_t drawn(const FlSearchWindows *w, const uint16_t centre[3], uint32_t key, int axis,
                      int k)
{
    const int reach = w->reach[axis][k], low = MAX(centre[axis] - reach, 0);
    const int high = MIN(centre[axis] + reach, w->size[axis] - 1);
    const uint32_t place = (uint32_t)(axis * FL_MAX_CANDIDATES + k) / 2;
    const uint32_t bits = fl_hash32(key + place * FL_HASH32_STEP) >> (k % 2 * 16) & 0xffff;
    return (uint32_t)low + (bits * (uint32_t)(high - low + 1) >> 16);
}

static void candidates_are_drawn_inside_the_windows(void)
{
    for (uint64_t seed = 1; seed <= 2000; seed++) {
        FlRng rng = {seed};
        FlSearchWindows w;
        FlCandidates got;
        make_windows(&w, seed % 2 ? 30 : 32767, &rng);
        uint16_t centre[3];
        for (int axis = 0; axis < 3; axis++)
            centre[axis] = (uint16_t)fl_rng_below(&rng, w.size[axis]);
        const uint32_t key = fl_rng_u32(&rng);
        fl_draw_candidates(&w, centre, key, &got);
        for (int k = 0; k < w.n; k++) {
            uint32_t pixel = 0;
            for (int axis = 0; axis < 3; axis++) {
                g_assert_cmpuint(got.at[axis][k], ==, drawn(&w, centre, key, axis, k));
                g_assert_cmpint(got.at[axis][k], <, w.size[axis]);
                g_assert_cmpint(abs(got.at[axis][k] - centre[axis]), <=, w.reach[axis][k]);
                pixel += got.at[axis][k] * w.step[axis];
            }
            g_assert_cmpuint(got.pixel[k], ==, pixel);
        }
    }
}

enum { CELLS = 8 }; // side of the occurrence map, in time too

static void make_filter(FlCandidateFilter *filter, const FlTexel *first, const int32_t *use,
                        FlRng *rng)
{
    *filter = (FlCandidateFilter){.first = first,
                                  .segment = (uint8_t)fl_rng_below(rng, 3),
                                  .use = use,
                                  .step = {1, CELLS, CELLS * CELLS},
                                  .factor = {10923, 10923, 8192},
                                  .price = (float)fl_rng_below(rng, 5000) / 7,
                                  .most = 536870912.0f,
                                  .limit = fl_rng_below(rng, 1u << 20),
                                  .frames = {-1, -1, (int16_t)fl_rng_below(rng, 16), -1}};
    for (int axis = 0; axis < 3; axis++)
        filter->own[axis] = (uint16_t)fl_rng_below(rng, CELLS);
}

/* The contract of fl_filter_candidates() for one of them, step by step. */
static bool passes(const FlCandidates *candidates, int k, const FlCandidateFilter *filter,
                   uint32_t *uniformity)
{
    size_t cell = 0;
    int own = 1;
    bool good = false;
    for (int axis = 0; axis < 3; axis++) {
        const uint32_t at = (2u * candidates->at[axis][k] + 1) * filter->factor[axis] >> 16;
        cell += at * filter->step[axis];
        own *= MAX(2 - abs((int)at - filter->own[axis]), 0);
    }
    const float price = (float)MAX(filter->use[cell] - own, 0) * filter->price;
    *uniformity = (uint32_t)MIN(price, filter->most);
    for (int f = 0; f < 4; f++)
        good |= (int16_t)candidates->at[2][k] == filter->frames[f];
    return (good || *uniformity < filter->limit) &&
           filter->first[candidates->pixel[k]].c[FL_CH_SEGMENT] == filter->segment;
}

static void candidates_pass_as_they_should(void)
{
    g_autofree FlTexel *texels = g_new(FlTexel, 24 * 24 * 16);
    int32_t use[CELLS * CELLS * CELLS];
    for (uint64_t seed = 1; seed <= 1000; seed++) {
        FlRng rng = {seed};
        FlSearchWindows w;
        FlCandidates candidates;
        FlCandidateFilter filter;
        uint32_t want, got[FL_MAX_CANDIDATES];
        make_windows(&w, 16, &rng);
        for (int k = 0; k < 16 * 16 * 16; k++)
            texels[k].c[FL_CH_SEGMENT] = (uint8_t)fl_rng_below(&rng, 3);
        for (int k = 0; k < CELLS * CELLS * CELLS; k++)
            use[k] = (int32_t)fl_rng_below(&rng, seed % 5 ? 3000 : INT32_MAX);
        fl_draw_candidates(&w, (uint16_t[3]){0, 0, 0}, fl_rng_u32(&rng), &candidates);
        make_filter(&filter, texels, use, &rng);
        const uint64_t passed = fl_filter_candidates(&candidates, w.n, &filter, got);
        for (int k = 0; k < w.n; k++) {
            g_assert_cmpint(passed >> k & 1, ==, passes(&candidates, k, &filter, &want));
            g_assert_cmpuint(got[k], ==, want);
        }
    }
}

enum { VOTED = 24, VOTED_FRAMES = 3, VOTED_PITCH = VOTED + 2 * FL_SPLINE_PAD };

/* Matches around a pixel, and an exemplar that they point into. */
typedef struct Votes {
    uint16_t x[FL_VOTES], y[FL_VOTES];
    int16_t frame[FL_VOTES], turn[FL_VOTES][2];
    FlSplinePixel colour[VOTED_FRAMES * VOTED_PITCH * VOTED_PITCH];
    FlVoteMatches covering;
    FlVoteSource voted;
} Votes;

/* In a part of the exemplar, so that some agree, and beyond its borders; of few angles. */
static void make_votes(Votes *v, FlRng *rng)
{
    const uint32_t spread = 1 + fl_rng_below(rng, 16 * VOTED - 1);
    const uint32_t angles = 1 + fl_rng_below(rng, 3), frames = 1 + fl_rng_below(rng, 4);
    const uint32_t far = 1 + 16 * VOTED - spread;
    const uint16_t x = (uint16_t)fl_rng_below(rng, far), y = (uint16_t)fl_rng_below(rng, far);
    for (int k = 0; k < FL_VOTES; k++) {
        v->x[k] = (uint16_t)(FL_VOTE_BIAS + x + fl_rng_below(rng, spread));
        v->y[k] = (uint16_t)(FL_VOTE_BIAS + y + fl_rng_below(rng, spread));
        v->frame[k] = (int16_t)(fl_rng_below(rng, frames) - 1);
        memcpy(v->turn[k], fl_turns[fl_rng_below(rng, angles) * 77 % FL_ANGLES], sizeof v->turn[k]);
    }
    for (size_t p = 0; p < G_N_ELEMENTS(v->colour); p++)
        for (int c = 0; c < 4; c++)
            v->colour[p].c[c] = (int16_t)(fl_rng_below(rng, 65535) - 32767);
    v->covering = (FlVoteMatches){v->x, v->y, v->frame, (const int16_t(*)[2])v->turn};
    v->voted = (FlVoteSource){.colour = v->colour + (FL_SPLINE_PAD - 1) * (VOTED_PITCH + 1),
                              .pitch = VOTED_PITCH,
                              .frame_pixels = VOTED_PITCH * VOTED_PITCH,
                              .most = {16 * (VOTED - 1), 16 * (VOTED - 1)}};
    for (int n = 1; n <= FL_PATCH_PIXELS; n++)
        v->voted.weight[n] = 0.5f + (float)fl_rng_below(rng, 1000);
}

static void votes_are_those_of_c(const void *version)
{
    const FlKernels *kernels = version;
    g_autofree Votes *v = g_new(Votes, 1);
    for (uint64_t seed = 1; seed <= 5000; seed++) {
        FlRng rng = {seed};
        float want[4], got[4];
        make_votes(v, &rng);
        const bool any = fl_vote_c(&v->covering, &v->voted, want);
        g_assert_cmpint(kernels->vote(&v->covering, &v->voted, got), ==, any);
        if (any)
            g_assert_cmpmem(got, sizeof got, want, sizeof want);
    }
}

static void doubled_votes_are_those_of_c(const void *version)
{
    const FlKernels *kernels = version;
    g_autofree Votes *v = g_new(Votes, 1);
    for (uint64_t seed = 1; seed <= 5000; seed++) {
        FlRng rng = {seed};
        float want[4][4], got[4][4];
        make_votes(v, &rng);
        const bool any = fl_vote_doubled_c(&v->covering, &v->voted, want);
        g_assert_cmpint(kernels->vote_doubled(&v->covering, &v->voted, got), ==, any);
        if (any)
            g_assert_cmpmem(got, sizeof got, want, sizeof want);
    }
}

static void splines_are_sampled_as_in_c(const void *version)
{
    const FlKernels *kernels = version;
    for (uint64_t seed = 1; seed <= 2000; seed++) {
        FlRng rng = {seed};
        FlSplinePixel pixels[64];
        for (int p = 0; p < 64; p++)
            for (int c = 0; c < 4; c++)
                pixels[p].c[c] = (int16_t)(fl_rng_below(&rng, 65535) - 32767);
        const FlSplinePhase *x = &fl_spline_phases[seed % 16];
        const FlSplinePhase *y = &fl_spline_phases[seed / 16 % 16];
        const size_t pitch = 4 + seed % 17;
        float want[4], got[4];
        fl_spline_sample_c(pixels, pitch, x->x, y->y, want);
        kernels->spline_sample(pixels, pitch, x->x, y->y, got);
        g_assert_cmpmem(got, sizeof got, want, sizeof want);
    }
}

/* A patch of each, and what is around the target's; the weights of edge and past at their most. */
static void make_fluids(FlFluidTexel *source, FlFluidTexel *target, int n_target, FlRng *rng,
                        bool extreme)
{
    static const int most[] = {2040, 2040, 2040, 3533, 12069};
    for (int k = 0; k < FL_PATCH_PIXELS + n_target; k++) {
        FlFluidTexel *pixel = k < FL_PATCH_PIXELS ? &source[k] : &target[k - FL_PATCH_PIXELS];
        for (int c = 0; c <= FL_FLUID_PAST_A; c++) {
            const int limit = c < 5                 ? most[c]
                              : c < FL_FLUID_PAST   ? 0
                              : c < FL_FLUID_PAST_A ? 4927
                                                    : 8533;
            pixel->c[c] = (int16_t)(extreme ? (k < FL_PATCH_PIXELS ? limit : 0)
                                            : (int)fl_rng_below(rng, (uint32_t)limit + 1));
        }
        if (k >= FL_PATCH_PIXELS)
            pixel->c[FL_FLUID_WEIGHT] =
                (int16_t)(extreme ? INT16_MAX : (int)fl_rng_below(rng, 32768));
    }
    for (int k = 0; extreme && k < FL_PATCH_PIXELS; k++) // eta 35 alone, or the past's share of it
        for (int c = FL_FLUID_PAST; c <= FL_FLUID_PAST_A; c++)
            source[k].c[c] = 0;
}

static void fluids_are_compared_as_in_c(const void *version)
{
    const FlKernels *kernels = version;
    for (uint64_t seed = 0; seed < 500; seed++) {
        FlRng rng = {seed};
        FlFluidTexel source[FL_PATCH_PIXELS], target[8 * FL_PATCH];
        make_fluids(source, target, 8 * FL_PATCH, &rng, seed == 0);
        const uint32_t want = fl_fluid_distance_c(source, target, 8, UINT32_MAX);
        g_assert_cmpuint(kernels->fluid_distance(source, target, 8, UINT32_MAX), ==, want);
        g_assert_cmpuint(kernels->fluid_distance(source, target, 8, want), ==, want);
        g_assert_cmpuint(kernels->fluid_distance(source, target, 8, want / 2), >, want / 2);
    }
}

#define CALLS 200000

static double since(double start)
{
    return (double)clock() / CLOCKS_PER_SEC - start;
}

static void print_time(const char *kernel, double seconds)
{
    printf("  %-14s %6.1f ns %6.1f M/s\n", kernel, seconds / CALLS * 1e9, CALLS / seconds * 1e-6);
}

#define TIME(name, call)                                                                           \
    do {                                                                                           \
        const double start = since(0);                                                             \
        for (uint32_t k = 0; k < CALLS; k++)                                                       \
            call;                                                                                  \
        print_time(name, since(start));                                                            \
    } while (0)

/* A patch whose distances run to the end, 20 candidates of which most are sifted out. */
static void time_version(const FlKernels *kernels)
{
    FlRng rng = {1};
    static Case c;
    static FlTexel texels[16 * 16 * 16];
    static const int32_t use[CELLS * CELLS * CELLS];
    static const FlSplinePixel pixels[64];
    FlSearchWindows w;
    FlCandidates candidates;
    FlCandidateFilter filter;
    static Votes votes;
    uint32_t pair[2], uniformity[FL_MAX_CANDIDATES];
    float value[4], four[4][4];
    make_case(&c, 1);
    make_windows(&w, 16, &rng);
    w.n = 20;
    make_filter(&filter, texels, use, &rng);
    do
        make_votes(&votes, &rng);
    while (!fl_vote_c(&votes.covering, &votes.voted, value));
    const FlTexel *centre = centre_of(&c, 1);
    puts(kernels->name);
    TIME("patch_distance",
         kernels->patch_distance(centre + k % 64, c.offsets, k % 2, c.target, &c.rest, UINT32_MAX));
    TIME("patch_pair",
         kernels->patch_pair(centre + k % 64, c.offsets, c.target, &c.rest, UINT32_MAX, pair));
    TIME("draw_candidates", fl_draw_candidates(&w, (uint16_t[3]){0, 0, 0}, k, &candidates));
    TIME("filter_candidates", fl_filter_candidates(&candidates, w.n, &filter, uniformity));
    TIME("vote", kernels->vote(&votes.covering, &votes.voted, value));
    TIME("vote_doubled", kernels->vote_doubled(&votes.covering, &votes.voted, four));
    TIME("spline_sample", kernels->spline_sample(pixels, 8, fl_spline_phases[k % 16].x,
                                                 fl_spline_phases[k % 16].y, value));
}

/** A check of one version; the argument is its FlKernels. */
typedef struct Check {
    const char *name;
    GTestDataFunc run;
} Check;

static const Check checks[] = {
    {"the-distance-is-that-of-c", the_distance_is_that_of_c},
    {"nothing-overflows-on-extremes", nothing_overflows_on_extremes},
    {"a-limit-never-changes-which-side-of-it-a-distance-is-on",
     a_limit_never_changes_which_side_of_it_a_distance_is_on},
    {"a-pair-is-the-distances-of-both-half-turns", a_pair_is_the_distances_of_both_half_turns},
    {"votes-are-those-of-c", votes_are_those_of_c},
    {"doubled-votes-are-those-of-c", doubled_votes_are_those_of_c},
    {"splines-are-sampled-as-in-c", splines_are_sampled_as_in_c},
    {"fluids-are-compared-as-in-c", fluids_are_compared_as_in_c},
};

static void add_checks(const FlKernels *version)
{
    for (size_t k = 0; k < G_N_ELEMENTS(checks); k++) {
        g_autofree char *path = g_strdup_printf("/kernels/%s/%s", version->name, checks[k].name);
        g_test_add_data_func(path, version, checks[k].run);
    }
}

int main(int argc, char **argv)
{
    const bool time = argc == 2 && g_str_equal(argv[1], "--time");
    FlKernels versions[G_N_ELEMENTS(levels)];
    const char *search = NULL;
    fl_rotation_init();
    fl_spline_init();
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/candidates/are-drawn-inside-the-windows",
                    candidates_are_drawn_inside_the_windows);
    g_test_add_func("/candidates/pass-as-they-should", candidates_pass_as_they_should);
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        if (!available(levels[v]))
            continue;
        // some levels have no kernels, or none in this build
        fl_kernels_init(&versions[v], levels[v]);
        if (g_strcmp0(versions[v].name, search) != 0)
            time ? time_version(&versions[v]) : add_checks(&versions[v]);
        search = versions[v].name;
    }
    return time ? 0 : g_test_run();
}
