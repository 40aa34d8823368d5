/* Every version of every kernel against C: exact equality on noise and on overflow bait. */
#include "base/rng.h"
#include "synth/kernels.h"
#include <glib.h>
#include <stdbool.h>
#include <string.h>

#define FIELD 64 // side of the exemplar that is sampled

typedef struct Case {
    FlTexel source[FIELD * FIELD];
    _Alignas(64) FlPacked target[FL_PATCH_PIXELS + 3], weight[FL_PATCH_PIXELS + 3];
    int32_t offsets[FL_PATCH_PIXELS];
} Case;

static void fill(FlPacked *pixels, int n, FlRng *rng, int limit)
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

static void make_case(Case *c, uint64_t seed)
{
    FlRng rng = {seed};
    fill_texels(c->source, FIELD * FIELD, &rng);
    fill(c->target, FL_PATCH_PIXELS, &rng, FL_ONE);
    fill(c->weight, FL_PATCH_PIXELS, &rng, 32767);
    for (int p = 0; p < FL_PATCH_PIXELS; p++)
        c->offsets[p] = (int32_t)fl_rng_below(&rng, 7) * FIELD + (int32_t)fl_rng_below(&rng, 7);
}

static const unsigned levels[] = {0, FL_CPU_AVX2, FL_CPU_AVX2 | FL_CPU_AVX512, FL_CPU_NEON};

/* A level that the processor lacks must not be run. */
static bool available(unsigned flags)
{
    return (fl_cpu_flags() & flags) == flags;
}

static void every_version_equals_c_on_noise(void)
{
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        FlKernels kernels;
        if (!available(levels[v]))
            continue;
        fl_kernels_init(&kernels, levels[v]);
        for (uint64_t seed = 1; seed <= 2000; seed++) {
            Case c;
            make_case(&c, seed);
            const FlTexel *centre = c.source + seed % 3000;
            const uint32_t want =
                fl_patch_distance_c(centre, c.offsets, c.target, c.weight, UINT32_MAX);
            const uint32_t got =
                kernels.patch_distance(centre, c.offsets, c.target, c.weight, UINT32_MAX);
            if (got != want)
                g_error("%s, seed %" G_GUINT64_FORMAT ": %u, want %u", kernels.name, seed, got,
                        want);
        }
    }
}

static void no_version_overflows_on_extremes(void)
{
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        FlKernels kernels;
        if (!available(levels[v]))
            continue;
        fl_kernels_init(&kernels, levels[v]);
        Case c = {0};
        for (int p = 0; p < FL_PATCH_PIXELS; p++)
            for (int k = 0; k < FL_CHANNELS; k++)
                c.target[p].c[k] = FL_ONE, c.weight[p].c[k] = 32767;
        const uint32_t got =
            kernels.patch_distance(c.source, c.offsets, c.target, c.weight, UINT32_MAX);
        g_assert_cmpuint(got, ==, 25u * 8 * FL_ONE * FL_ONE);
    }
}

static void a_limit_never_changes_which_side_of_it_a_distance_is_on(void)
{
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        FlKernels kernels;
        if (!available(levels[v]))
            continue;
        fl_kernels_init(&kernels, levels[v]);
        for (uint64_t seed = 1; seed <= 500; seed++) {
            Case c;
            make_case(&c, seed);
            const uint32_t whole =
                fl_patch_distance_c(c.source, c.offsets, c.target, c.weight, UINT32_MAX);
            const uint32_t at =
                kernels.patch_distance(c.source, c.offsets, c.target, c.weight, whole);
            const uint32_t below =
                kernels.patch_distance(c.source, c.offsets, c.target, c.weight, whole - 1);
            g_assert_cmpuint(at, ==, whole);
            g_assert_cmpuint(below, >, whole - 1);
        }
    }
}

static void make_votes(FlVotes *votes, FlRng *rng)
{
    const uint32_t spread = 1 + fl_rng_below(rng, 60);
    for (int k = 0; k < 32; k++) {
        votes->x[k] = (uint16_t)(fl_rng_below(rng, spread) + (fl_rng_below(rng, 2) ? 65000 : 30));
        votes->y[k] = (uint16_t)fl_rng_below(rng, spread);
        votes->frame[k] = (int16_t)(fl_rng_below(rng, 4) - 1);
    }
}

static void every_version_sorts_votes_like_c(void)
{
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        FlKernels kernels;
        if (!available(levels[v]))
            continue;
        fl_kernels_init(&kernels, levels[v]);
        for (uint64_t seed = 1; seed <= 2000; seed++) {
            FlRng rng = {seed};
            FlVotes votes;
            FlOpinion want[FL_PATCH_PIXELS], got[FL_PATCH_PIXELS];
            make_votes(&votes, &rng);
            const int n = fl_find_opinions_c(&votes, want);
            g_assert_cmpint(kernels.opinions(&votes, got), ==, n);
            g_assert_cmpmem(got, n * sizeof *got, want, n * sizeof *want);
        }
    }
}

static void every_version_samples_splines_like_c(void)
{
    for (size_t v = 0; v < G_N_ELEMENTS(levels); v++) {
        FlKernels kernels;
        if (!available(levels[v]))
            continue;
        fl_kernels_init(&kernels, levels[v]);
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
            kernels.spline_sample(pixels, pitch, x->x, y->y, got);
            g_assert_cmpmem(got, sizeof got, want, sizeof want);
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    fl_rotation_init();
    fl_spline_init();
    g_test_add_func("/kernels/every-version-equals-c-on-noise", every_version_equals_c_on_noise);
    g_test_add_func("/kernels/no-version-overflows-on-extremes", no_version_overflows_on_extremes);
    g_test_add_func("/kernels/a-limit-never-changes-which-side-of-it-a-distance-is-on",
                    a_limit_never_changes_which_side_of_it_a_distance_is_on);
    g_test_add_func("/kernels/every-version-sorts-votes-like-c", every_version_sorts_votes_like_c);
    g_test_add_func("/kernels/every-version-samples-splines-like-c",
                    every_version_samples_splines_like_c);
    return g_test_run();
}
