#include "base/rng.h"
#include "lazy/retrieve.h"
#include "synth/kernels.h"
#include "threads.h"
#include <math.h>
#include <string.h>

/* A picture of smooth blobs in colours, whole numbers of pixels large. */
typedef struct Picture {
    FlFluidPicture fluid;
    FlFluidTexel *pixels;
} Picture;

static float blobs(float x, float y, uint64_t seed)
{
    float value = 0;
    for (uint64_t k = 0; k < 6; k++) {
        FlRng rng = {fl_key(seed, k)};
        const float turn = fl_rng_float(&rng) * 6.2832f, length = 6 + 18 * fl_rng_float(&rng);
        const float phase = fl_rng_float(&rng) * 6.2832f;
        value += sinf((x * cosf(turn) + y * sinf(turn)) * 6.2832f / length + phase) / 6;
    }
    return 0.5f + 0.5f * value;
}

static Picture picture_new(int width, int height, uint64_t seed)
{
    const int pitch = width + 2 * FL_PATCH_RADIUS;
    Picture p = {.fluid = {.width = width, .height = height, .pitch = pitch}};
    const size_t n = (size_t)pitch * (size_t)(height + 2 * FL_PATCH_RADIUS);
    p.pixels = aligned_alloc(32, n * sizeof *p.pixels);
    memset(p.pixels, 0, n * sizeof *p.pixels);
    for (size_t k = 0; k < n; k++)
        for (int c = 0; c < 3; c++)
            p.pixels[k].c[c] =
                (int16_t)(FL_FLUID_ONE * blobs((float)(k % (size_t)pitch),
                                               (float)(k / (size_t)pitch), seed + (uint64_t)c / 2));
    p.fluid.pixel = p.pixels + FL_PATCH_RADIUS * pitch + FL_PATCH_RADIUS;
    return p;
}

static uint32_t *all_of(const FlFluidPicture *picture, size_t *n, bool (*inside)(int x, int y))
{
    uint32_t *places = g_new(uint32_t, (size_t)picture->width * (size_t)picture->height + 1);
    *n = 0;
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++)
            if (!inside || inside(x, y))
                places[(*n)++] = (uint32_t)(y * picture->width + x);
    return places;
}

typedef struct Case {
    int source, source_height, target, target_height;
    bool (*inside)(int x, int y);
    bool turns;
    FlUniform uniform;
} Case;

/* Retrieves from nothing, then `again` from what was retrieved, as rounds do; the field is the
 * caller's. */
static FlRetrieved retrieve_again(const Case *c, int again, FlNnf *nnf, size_t use[])
{
    g_autoptr(GError) error = NULL;
    fl_rotation_init();
    FlKernels kernels;
    fl_kernels_init(&kernels, fl_cpu_flags());
    Picture source = picture_new(c->source, c->source_height, 1);
    Picture target = picture_new(c->target, c->target_height, 77);
    FlRetrieval in = {.source = source.fluid,
                      .target = target.fluid,
                      .turns = c->turns,
                      .uniform = c->uniform,
                      .sweeps = 1,
                      .key = 5,
                      .distance = kernels.fluid_distance};
    g_autofree uint32_t *sources = all_of(&source.fluid, &in.n_sources, NULL);
    g_autofree uint32_t *targets = all_of(&target.fluid, &in.n_targets, c->inside);
    in.sources = sources, in.targets = targets;
    FlRetrieved done;
    g_assert_true(fl_nnf_init(nnf, c->target, c->target_height, &error));
    for (int round = 0; round <= again; round++, in.key++)
        g_assert_true(fl_retrieve(&in, nnf, &done, &error));
    for (size_t k = 0; use && k < in.n_targets; k++) {
        const FlMatch m = nnf->match[targets[k]];
        g_assert_cmpint(m.frame, ==, 0);
        use[4 * (size_t)(fl_match_y(m) * c->source + fl_match_x(m)) + m.theta / 64]++;
    }
    free(source.pixels);
    free(target.pixels);
    return done;
}

static FlRetrieved retrieve(const Case *c, FlNnf *nnf, size_t use[])
{
    return retrieve_again(c, 0, nnf, use);
}

static bool in_disc(int x, int y)
{
    return (x - 40) * (x - 40) + (y - 40) * (y - 40) < 900;
}

static bool in_dots(int x, int y)
{
    return (y - 10) * (y - 10) + (x % 30 - 10) * (x % 30 - 10) < 40;
}

static bool in_one(int x, int y)
{
    return x == 3 && y == 4;
}

static bool nowhere(int x, int y)
{
    return x < 0 && y < 0;
}

static void every_patch_is_used_k_or_k_plus_one_times(void)
{
    static const Case cases[] = {
        {24, 24, 80, 80, in_disc, true, FL_UNIFORM_PATCH},
        {24, 24, 80, 80, in_disc, false, FL_UNIFORM_PATCH},
        {20, 17, 300, 12, NULL, true, FL_UNIFORM_PATCH},
        {20, 17, 90, 20, in_dots, false, FL_UNIFORM_PATCH},
        {60, 60, 40, 40, NULL, true, FL_UNIFORM_PATCH}, // K = 0
        {1, 1, 40, 40, NULL, false, FL_UNIFORM_PATCH},  // a source of one pixel
        {20, 20, 40, 40, in_one, true, FL_UNIFORM_PATCH},
        {20, 20, 40, 40, nowhere, true, FL_UNIFORM_PATCH},
    };
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++) {
        const Case *c = &cases[k];
        const size_t n = (size_t)(c->source * c->source_height) * (c->turns ? 4 : 1);
        g_autofree size_t *use = g_new0(size_t, 4 * (size_t)(c->source * c->source_height));
        g_auto(FlNnf) nnf = {0};
        const FlRetrieved done = retrieve(c, &nnf, use);
        size_t sum = 0, beyond = 0;
        for (size_t s = 0; s < 4 * (size_t)(c->source * c->source_height); s++)
            sum += use[s];
        for (size_t s = 0; s < 4 * (size_t)(c->source * c->source_height); s++) {
            g_assert_cmpuint(use[s], <=, sum / n + 1);
            g_assert_true(use[s] >= sum / n || (!c->turns && s % 4 != 0));
            beyond += use[s] == sum / n + 1;
        }
        g_assert_cmpuint(beyond, ==, sum % n);
        g_assert_cmpint(done.passes, <=, 64 + (int)(sum / n));
    }
}

/* The loop of [L15 section 4.1] as it stands there: the counters, the sorting, everything. */
static double literal(const Case *c)
{
    FlKernels kernels;
    fl_kernels_init(&kernels, fl_cpu_flags());
    Picture source = picture_new(c->source, c->source_height, 1);
    Picture target = picture_new(c->target, c->target_height, 77);
    size_t n_s, n_t;
    g_autofree uint32_t *sources = all_of(&source.fluid, &n_s, NULL);
    g_autofree uint32_t *targets = all_of(&target.fluid, &n_t, c->inside);
    g_autofree uint32_t *cost = g_new(uint32_t, n_s * n_t);
    g_autofree size_t *use = g_new0(size_t, n_s), *to = g_new0(size_t, n_s);
    g_autofree bool *taken = g_new0(bool, n_t);
    for (size_t s = 0; s < n_s; s++) {
        FlFluidTexel patch[FL_PATCH_PIXELS];
        const int x = (int)sources[s] % c->source, y = (int)sources[s] / c->source;
        for (int k = 0; k < FL_PATCH_PIXELS; k++)
            patch[k] = source.fluid.pixel[(y + k / 5 - 2) * source.fluid.pitch + x + k % 5 - 2];
        for (size_t t = 0; t < n_t; t++) {
            const int tx = (int)targets[t] % c->target, ty = (int)targets[t] / c->target;
            cost[s * n_t + t] = kernels.fluid_distance(
                patch, target.fluid.pixel + (ty - 2) * target.fluid.pitch + tx - 2,
                target.fluid.pitch, UINT32_MAX);
        }
    }
    size_t left = n_t, quota = n_t / n_s, extra = n_t % n_s;
    double energy = 0;
    while (left > 0) {
        g_autofree size_t *best = g_new(size_t, n_t); // by target: the nearest source; n_s: none
        for (size_t t = 0; t < n_t; t++)
            best[t] = n_s;
        for (size_t s = 0; s < n_s; s++) {
            if (use[s] > quota || (use[s] == quota && extra == 0))
                continue;
            to[s] = n_t;
            for (size_t t = 0; t < n_t; t++)
                if (!taken[t] && (to[s] == n_t || cost[s * n_t + t] < cost[s * n_t + to[s]]))
                    to[s] = t;
            const size_t held = best[to[s]];
            if (held == n_s || cost[s * n_t + to[s]] < cost[held * n_t + to[s]])
                best[to[s]] = s;
        }
        for (;;) { // in order of cost
            size_t next = n_t;
            for (size_t t = 0; t < n_t; t++)
                if (best[t] < n_s &&
                    (next == n_t || cost[best[t] * n_t + t] < cost[best[next] * n_t + next]))
                    next = t;
            if (next == n_t)
                break;
            const size_t s = best[next];
            best[next] = n_s;
            if (use[s] == quota && extra == 0)
                continue;
            extra -= use[s] == quota;
            use[s]++, taken[next] = true, left--;
            energy += (double)cost[s * n_t + next] / ((double)FL_FLUID_ONE * FL_FLUID_ONE);
        }
    }
    free(source.pixels);
    free(target.pixels);
    return energy;
}

static void the_energy_is_near_that_of_the_literal_loop(void)
{
    static const Case cases[] = {{12, 12, 40, 40, NULL, false, FL_UNIFORM_PATCH},
                                 {32, 32, 50, 50, NULL, false, FL_UNIFORM_PATCH},
                                 {48, 48, 80, 80, in_disc, false, FL_UNIFORM_PATCH}};
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++) {
        g_auto(FlNnf) nnf = {0};
        const FlRetrieved done = retrieve_again(&cases[k], 2, &nnf, NULL);
        const double want = literal(&cases[k]);
        g_test_message("energy %.4f of the literal loop's, %d passes", done.energy / want,
                       done.passes);
        g_assert_cmpfloat(done.energy, <=, 1.25 * want); // pictures without likeness are hardest
        g_assert_cmpfloat(done.energy, >=, 0.8 * want);
    }
}

static void with_a_table_it_is_the_literal_loop(void)
{
    static const Case c = {12, 12, 40, 40, NULL, false, FL_UNIFORM_PATCH};
    g_auto(FlNnf) nnf = {0};
    g_assert_cmpfloat(fabs(retrieve(&c, &nnf, NULL).energy / literal(&c) - 1), <, 0.02);
}

static void passes_and_evaluations_are_few(void)
{
    static const Case c = {48, 48, 180, 180, NULL, true, FL_UNIFORM_PATCH};
    g_auto(FlNnf) nnf = {0};
    const FlRetrieved done = retrieve_again(&c, 1, &nnf, NULL);
    const double each = (double)done.evaluations / (180 * 180);
    g_test_message("%d passes, %.1f evaluations a target", done.passes, each);
    g_assert_cmpint(done.passes, <=, 60);
    g_assert_cmpfloat(each, <=, 20);
}

static void blocks_are_used_equally_where_patches_are_too_many(void)
{
    static const Case c = {60, 60, 40, 40, NULL, false, FL_UNIFORM_AUTO};
    g_auto(FlNnf) nnf = {0};
    g_autofree size_t *use = g_new0(size_t, 4 * 60 * 60);
    const FlRetrieved done = retrieve(&c, &nnf, use);
    g_assert_cmpint(done.least, ==, 1);
    g_assert_cmpint(done.most, ==, 2);
    size_t block[30 * 30] = {0};
    for (size_t s = 0; s < 60 * 60; s++)
        block[s / 60 / 2 * 30 + s % 60 / 2] += use[4 * s];
    for (int k = 0; k < 30 * 30; k++)
        g_assert_true(block[k] == 1 || block[k] == 2);
}

static void nearest_neighbours_cost_less_and_use_few(void)
{
    static const Case strict = {24, 24, 60, 60, NULL, false, FL_UNIFORM_PATCH};
    static const Case off = {24, 24, 60, 60, NULL, false, FL_UNIFORM_OFF};
    g_auto(FlNnf) a = {0}, b = {0};
    g_autofree size_t *use = g_new0(size_t, 4 * 24 * 24);
    const double want = retrieve(&strict, &a, NULL).energy;
    g_assert_cmpfloat(retrieve(&off, &b, use).energy, <, want);
    size_t most = 0;
    for (size_t s = 0; s < 4 * 24 * 24; s++)
        most = MAX(most, use[s]);
    g_assert_cmpuint(most, >, 3 * (60 * 60 / (24 * 24)));
}

static void the_same_field_on_any_number_of_threads(void)
{
    for (FlUniform uniform = FL_UNIFORM_AUTO; uniform <= FL_UNIFORM_OFF; uniform++) {
        const Case c = {70, 70, 90, 90, NULL, true, uniform};
        g_auto(FlNnf) one = {0};
        omp_set_num_threads(1);
        retrieve(&c, &one, NULL);
        for (int threads = 2; threads <= 5; threads += 3) {
            g_auto(FlNnf) many = {0};
            omp_set_num_threads(threads);
            retrieve(&c, &many, NULL);
            g_assert_cmpmem(many.match, 90 * 90 * sizeof(FlMatch), one.match,
                            90 * 90 * sizeof(FlMatch));
        }
    }
}

int main(int argc, char **argv)
{
    g_test_init(&argc, &argv, NULL);
    g_test_add_func("/retrieve/every-patch-is-used-k-or-k-plus-one-times",
                    every_patch_is_used_k_or_k_plus_one_times);
    g_test_add_func("/retrieve/the-energy-is-near-that-of-the-literal-loop",
                    the_energy_is_near_that_of_the_literal_loop);
    g_test_add_func("/retrieve/with-a-table-it-is-the-literal-loop",
                    with_a_table_it_is_the_literal_loop);
    g_test_add_func("/retrieve/passes-and-evaluations-are-few", passes_and_evaluations_are_few);
    g_test_add_func("/retrieve/blocks-are-used-equally-where-patches-are-too-many",
                    blocks_are_used_equally_where_patches_are_too_many);
    g_test_add_func("/retrieve/nearest-neighbours-cost-less-and-use-few",
                    nearest_neighbours_cost_less_and_use_few);
    g_test_add_func("/retrieve/the-same-field-on-any-number-of-threads",
                    the_same_field_on_any_number_of_threads);
    return g_test_run();
}
