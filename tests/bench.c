/*
 * How fast is the synthesis: the animations of [F21 table 2] by size, style and painted pixels.
 *
 * usage: bench [--frames N] [--threads N] [--detail WORD] [--case NAME] [--json FILE] [--rounds N]
 *              [--compare OTHER_BENCH] [--set NAME=VALUE]…
 *
 * Each case runs in a process of its own, so that its peak memory is its own. Of N frames the first
 * starts from nothing and is left out of the means; a few more, not timed, tell the shares of the
 * stages, the patch evaluations and the energy, whose statistics cost time. With --compare every
 * case runs in both programs in turn; medians and their ratio are printed.
 *
 * An evaluation is a patch distance that is started; a try is a match that is thought of, with
 * those that are ruled out before their patch is looked at. Core-seconds, evaluations and tries are
 * per second of processor time, and `scaling`, how much longer all threads worked than the busiest
 * one, is what threads gain where they are not kept waiting: these hold on a machine that has other
 * things to do. OMP_WAIT_POLICY=passive is set, so that waiting is not working.
 *
 * The energy is that of the data; the total one has uniformity and coherence with it, which a
 * search that breaks up the field pays for; `first` is the first frame's. Each of N rounds has a
 * seed of its own.
 */
#include "base/rect.h"
#include "config.h"
#include "default_params.h"
#include "synth/synth.h"
#include "threads.h"
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/resource.h>
#include <time.h>

#define FRAMES_MEASURED 3 // for the statistics

typedef struct Case {
    const char *name, *style;
    int width, height, painted_px;
    int px; // of the page per px of this
} Case;

static const Case cases[] = {
    {"genie", "01", 900, 900, 123000, 1},    {"horse", "02", 1000, 800, 111000, 1},
    {"sunflower", "03", 500, 600, 60000, 1}, {"waving", "05", 640, 740, 80000, 1},
    {"jump", "06", 700, 300, 12000, 1},
};

static Case half_of(const Case *c)
{
    return (Case){c->name,           c->style, fl_half_side(c->width), fl_half_side(c->height),
                  c->painted_px / 4, 2 * c->px};
}

/* What one run of a case says; the words are the JSON's. */
#define FIGURES(F)                                                                                 \
    F(frame_s)                                                                                     \
    F(first_frame_s)                                                                               \
    F(guides_s)                                                                                    \
    F(target_s)                                                                                    \
    F(temporal_s)                                                                                  \
    F(search_s)                                                                                    \
    F(vote_s)                                                                                      \
    F(core_s_per_mpx)                                                                              \
    F(s_per_mpx)                                                                                   \
    F(scaling)                                                                                     \
    F(evaluations_per_px)                                                                          \
    F(evaluations_per_s_core)                                                                      \
    F(tries_per_s_core)                                                                            \
    F(energy)                                                                                      \
    F(total_energy)                                                                                \
    F(first_total_energy)                                                                          \
    F(painted_px)                                                                                  \
    F(peak_mib)

typedef struct Figures {
#define FIELD(name) double name;
    FIGURES(FIELD)
#undef FIELD
} Figures;

static int frames = 12, threads = 2, rounds = 1, seed = 1;
static char *detail = NULL, *only = NULL, *json = NULL, *other = NULL, *run = NULL;
static char **settings = NULL; // NAME=VALUE

static const GOptionEntry options[] = {
    {"frames", 0, 0, G_OPTION_ARG_INT, &frames, "timed frames of each case", "N"},
    {"threads", 0, 0, G_OPTION_ARG_INT, &threads, "threads", "N"},
    {"detail", 0, 0, G_OPTION_ARG_STRING, &detail, "draft, normal, fine or finest", "WORD"},
    {"case", 0, 0, G_OPTION_ARG_STRING, &only, "this case only", "NAME"},
    {"json", 0, 0, G_OPTION_ARG_FILENAME, &json, "write the figures", "FILE"},
    {"rounds", 0, 0, G_OPTION_ARG_INT, &rounds, "medians of N runs", "N"},
    {"compare", 0, 0, G_OPTION_ARG_FILENAME, &other, "another build's bench", "PROGRAM"},
    {"seed", 0, G_OPTION_FLAG_HIDDEN, G_OPTION_ARG_INT, &seed, NULL, NULL},
    {"set", 0, 0, G_OPTION_ARG_STRING_ARRAY, &settings,
     "a parameter of the synthesis; not for the other build", "NAME=VALUE"},
    {"run", 0, G_OPTION_FLAG_HIDDEN, G_OPTION_ARG_STRING, &run, NULL, NULL},
    {0}};

/* A three-lobed blob that turns, breathes and drifts; made anew at every call. */
static bool blob(void *data, int frame, uint8_t *coverage, GError **error)
{
    const Case *c = data;
    const double radius = sqrt(c->painted_px / (G_PI * 1.02)), phase = frame * 0.12;
    const double way = 8.0 / c->px;
    const double cx = c->width * 0.5 + way * sin(phase);
    const double cy = c->height * 0.5 + way * cos(0.7 * phase);
    memset(coverage, 0, (size_t)c->width * c->height);
    for (int y = 0; y < c->height; y++)
        for (int x = 0; x < c->width; x++) {
            const double dx = x - cx, dy = y - cy, r = hypot(dx, dy);
            if (r > 1.25 * radius)
                continue;
            const double lobes = 0.2 * (1 + 0.2 * sin(phase)) * sin(3 * atan2(dy, dx) + phase);
            const double inside = radius * (1 + lobes) - r + 0.5;
            coverage[(size_t)y * c->width + x] = (uint8_t)(CLAMP(inside, 0, 1) * 255);
        }
    return true;
}

static double seconds(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* A case in hand. */
typedef struct Bench {
    const Case *c;
    FlSynth *synth;
    FlGuideSequence *sequence;
    FlGuides guides;
    uint8_t *rgb;
} Bench;

static bool timed_frames(Bench *b, Figures *f, GError **error)
{
    double wall = 0, cpu = 0, busiest = 0;
    for (int k = 0; k <= frames; k++) {
        const double start = seconds(CLOCK_MONOTONIC);
        if (!fl_guide_sequence_get(b->sequence, k, &b->guides, error))
            return false;
        const double painting = seconds(CLOCK_MONOTONIC);
        const double used = seconds(CLOCK_PROCESS_CPUTIME_ID);
        const double own = seconds(CLOCK_THREAD_CPUTIME_ID); // the first thread does the rest too
        if (!fl_synth_frame(b->synth, &b->guides, b->rgb, NULL, NULL, error))
            return false;
        const double took = seconds(CLOCK_MONOTONIC) - painting;
        f->guides_s += (painting - start) / (frames + 1);
        if (k == 0) {
            f->first_frame_s = took;
            continue;
        }
        wall += took;
        cpu += seconds(CLOCK_PROCESS_CPUTIME_ID) - used;
        busiest += seconds(CLOCK_THREAD_CPUTIME_ID) - own;
    }
    f->scaling = cpu / busiest;
    f->frame_s = wall / frames;
    f->core_s_per_mpx = cpu / frames * 1e6; // to be divided by the pixels
    return true;
}

/* Of the frame in hand, in px of the page. */
static double painted_pixels(const Bench *b)
{
    double n = 0;
    for (size_t p = 0; p < (size_t)b->guides.width * b->guides.height; p++)
        n += b->guides.mask[p] >= FL_INSIDE;
    return n * b->c->px * b->c->px;
}

static double total_energy(const FlLevelStats *level)
{
    return level->energy + level->uniformity + level->coherence;
}

static bool measured_frames(Bench *b, Figures *f, GError **error)
{
    double drawn = 0, tried = 0;
    fl_synth_measure(b->synth, true);
    for (int k = 1; k <= FRAMES_MEASURED; k++) {
        FlFrameStats s;
        if (!fl_guide_sequence_get(b->sequence, frames + k, &b->guides, error) ||
            !fl_synth_frame(b->synth, &b->guides, b->rgb, &s, NULL, error))
            return false;
        for (int l = 0; l < s.n_levels; l++) {
            drawn += (double)s.level[l].counts.drawn / FRAMES_MEASURED;
            tried += (double)s.level[l].counts.tried / FRAMES_MEASURED;
        }
        const FlLevelStats *finest = &s.level[0];
        f->energy += finest->energy / FRAMES_MEASURED;
        f->total_energy += total_energy(finest) / FRAMES_MEASURED;
        f->target_s += s.seconds_target / FRAMES_MEASURED;
        f->temporal_s += s.seconds_temporal / FRAMES_MEASURED;
        f->search_s += s.seconds_search / FRAMES_MEASURED;
        f->vote_s += s.seconds_vote / FRAMES_MEASURED;
    }
    f->painted_px = painted_pixels(b);
    f->evaluations_per_px = tried / f->painted_px;
    f->core_s_per_mpx /= f->painted_px;
    const double stages = f->target_s + f->temporal_s + f->search_s + f->vote_s;
    const double searching = f->core_s_per_mpx * 1e-6 * f->search_s / stages; // a pixel, core-s
    f->evaluations_per_s_core = f->evaluations_per_px / searching;
    f->tries_per_s_core = drawn / f->painted_px / searching;
    f->s_per_mpx = f->frame_s / f->painted_px * 1e6;
    return true;
}

/* Of the first frame once more: it is timed without statistics. */
static bool measure_first(Bench *b, FlSynth *synth, Figures *f, GError **error)
{
    FlFrameStats stats;
    fl_synth_measure(synth, true);
    if (!fl_guide_sequence_get(b->sequence, 0, &b->guides, error) ||
        !fl_synth_frame(synth, &b->guides, b->rgb, &stats, NULL, error))
        return false;
    f->first_total_energy = total_energy(&stats.level[0]);
    return true;
}

static FlDetail detail_of_word(void)
{
    if (detail && g_str_equal(detail, "draft"))
        return FL_DETAIL_DRAFT;
    if (detail && g_str_equal(detail, "finest"))
        return FL_DETAIL_FINEST;
    return detail && g_str_equal(detail, "fine") ? FL_DETAIL_FINE : FL_DETAIL_NORMAL;
}

static bool set_params(FlParams *params, GError **error)
{
    fl_params_detail(params, detail_of_word());
    for (int k = 0; settings && settings[k]; k++) {
        g_auto(GStrv) parts = g_strsplit(settings[k], "=", 2);
        if (!fl_params_set(params, parts[0], parts[1] ? parts[1] : "", error))
            return false;
    }
    return true;
}

static bool run_case(const Case *c, Figures *f, GError **error)
{
    g_autofree char *folder = g_build_filename(STYLES, c->style, NULL);
    g_autofree FlParams *params = default_params();
    if (!set_params(params, error))
        return false;
    g_autoptr(FlStyle) style = fl_style_load(folder, error);
    g_autoptr(FlExemplar) exemplar =
        style ? (params->half_field ? fl_exemplar_new_half : fl_exemplar_new)(style, params, error)
              : NULL;
    if (!exemplar)
        return false;
    const Case field = params->half_field ? half_of(c) : *c;
    if (params->half_field)
        fl_params_scale_lengths(params, .5f);
    const FlGuideParams how = fl_guide_params(params);
    const int n = frames + 1 + FRAMES_MEASURED;
    const FlGuideSource source = {field.width, field.height, n, blob, NULL, (void *)&field};
    const FlSynthSize size = {c->width, c->height, c->width, c->height};
    Bench b = {.c = &field};
    const double start = seconds(CLOCK_MONOTONIC);
    b.sequence = fl_guide_sequence_new(&source, &how, error);
    f->guides_s = (seconds(CLOCK_MONOTONIC) - start) / source.n_frames;
    b.synth = b.sequence ? fl_synth_new(exemplar, params, size, (uint64_t)seed) : NULL;
    b.rgb = g_malloc(3 * (size_t)c->width * c->height);
    g_autoptr(FlSynth) first = fl_synth_new(exemplar, params, size, (uint64_t)seed);
    const bool ok = b.synth && fl_guides_init(&b.guides, source.width, source.height, error) &&
                    timed_frames(&b, f, error) && measured_frames(&b, f, error) &&
                    measure_first(&b, first, f, error);
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    f->peak_mib = (double)usage.ru_maxrss / 1024;
    g_free(b.rgb);
    fl_guides_clear(&b.guides);
    fl_synth_free(b.synth);
    fl_guide_sequence_free(b.sequence);
    return ok;
}

static char *as_json(const Figures *f)
{
    GString *text = g_string_new("{");
#define WRITE(name)                                                                                \
    g_string_append_printf(text, "%s\"%s\": %.6g", text->len > 1 ? ", " : "", #name, f->name);
    FIGURES(WRITE)
#undef WRITE
    g_string_append(text, "}");
    return g_string_free(text, FALSE);
}

static double figure_in(const char *text, const char *name)
{
    g_autofree char *key = g_strdup_printf("\"%s\": ", name);
    const char *at = strstr(text, key);
    return at ? g_ascii_strtod(at + strlen(key), NULL) : NAN;
}

/* Runs a case in a process of its own. */
static bool spawn(const char *program, const char *name, int round, Figures *f, GError **error)
{
    g_autofree char *n = g_strdup_printf("%d", frames), *t = g_strdup_printf("%d", threads),
                    *s = g_strdup_printf("%d", round + 1);
    g_autofree char *text = NULL;
    g_setenv("OMP_WAIT_POLICY", "passive", TRUE);
    g_autoptr(GPtrArray) argv = g_ptr_array_new();
    const char *const words[] = {program,     "--run", name,     "--frames", n,
                                 "--threads", t,       "--seed", s};
    for (size_t k = 0; k < G_N_ELEMENTS(words); k++)
        g_ptr_array_add(argv, (char *)words[k]);
    if (detail)
        g_ptr_array_add(argv, (char *)"--detail"), g_ptr_array_add(argv, detail);
    for (int k = 0; settings && program != other && settings[k]; k++)
        g_ptr_array_add(argv, (char *)"--set"), g_ptr_array_add(argv, settings[k]);
    g_ptr_array_add(argv, NULL);
    int status;
    if (!g_spawn_sync(NULL, (char **)argv->pdata, NULL, 0, NULL, NULL, &text, NULL, &status,
                      error) ||
        !g_spawn_check_wait_status(status, error))
        return false;
#define READ(name) f->name = figure_in(text, #name);
    FIGURES(READ)
#undef READ
    return true;
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static Figures medians(const Figures *runs, int n)
{
    Figures f;
    g_autofree double *values = g_new(double, n);
#define MEDIAN(name)                                                                               \
    for (int k = 0; k < n; k++)                                                                    \
        values[k] = runs[k].name;                                                                  \
    qsort(values, n, sizeof *values, by_value);                                                    \
    f.name = n % 2 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
    FIGURES(MEDIAN)
#undef MEDIAN
    return f;
}

static void print_row(const char *name, const Figures *f)
{
    printf("%-10s %7.0f %8.3f %8.3f %7.3f %7.3f %7.3f %7.3f %7.3f %8.2f %7.2f %7.1f %7.1f %7.1f "
           "%7.3f %7.3f %7.3f %6.0f\n",
           name, f->painted_px, f->frame_s, f->first_frame_s, f->guides_s, f->target_s,
           f->temporal_s, f->search_s, f->vote_s, f->core_s_per_mpx, f->scaling,
           f->evaluations_per_px, f->evaluations_per_s_core * 1e-6, f->tries_per_s_core * 1e-6,
           f->energy, f->total_energy, f->first_total_energy, f->peak_mib);
}

/* One case, in this program and the other in turn. */
static bool compare_case(const char *self, const Case *c, GString *out, GError **error)
{
    g_autofree Figures *own = g_new0(Figures, rounds), *others = g_new0(Figures, rounds);
    for (int k = 0; k < rounds; k++)
        if (!spawn(self, c->name, k, &own[k], error) ||
            (other && !spawn(other, c->name, k, &others[k], error)))
            return false;
    const Figures f = medians(own, rounds);
    print_row(c->name, &f);
    g_autofree char *text = as_json(&f);
    g_string_append_printf(out, "%s\n  \"%s\": %s", out->len > 1 ? "," : "", c->name, text);
    if (!other)
        return true;
    const Figures o = medians(others, rounds);
    print_row("  other", &o);
    printf("  ratio    frame %.2f, core-s/Mpx %.2f, evaluations/s %.2f, energy %.3f, total %.3f, "
           "first frame %.2f, its total %.3f, memory %.2f\n",
           f.frame_s / o.frame_s, f.core_s_per_mpx / o.core_s_per_mpx,
           f.evaluations_per_s_core / o.evaluations_per_s_core, f.energy / o.energy,
           f.total_energy / o.total_energy, f.first_frame_s / o.first_frame_s,
           f.first_total_energy / o.first_total_energy, f.peak_mib / o.peak_mib);
    return true;
}

static bool run_hidden(const char *name, GError **error)
{
#ifdef _OPENMP
    omp_set_num_threads(threads);
#endif
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++)
        if (g_str_equal(cases[k].name, name)) {
            Figures f = {0};
            const Case half = half_of(&cases[k]);
            if (!run_case(detail_of_word() == FL_DETAIL_DRAFT ? &half : &cases[k], &f, error))
                return false;
            g_autofree char *text = as_json(&f);
            puts(text);
        }
    return true;
}

static bool run_all(const char *self, GError **error)
{
    g_autoptr(GString) out = g_string_new("{");
    printf("%d frames, %d threads, medians of %d; seconds per frame\n", frames, threads, rounds);
    puts("case       painted    frame    first  guides  target    temp  search    vote core/Mpx"
         " scaling eval/px Meval/s Mtry/s  energy   total   first    MiB");
    for (size_t k = 0; k < G_N_ELEMENTS(cases); k++)
        if ((!only || g_str_equal(cases[k].name, only)) &&
            !compare_case(self, &cases[k], out, error))
            return false;
    g_string_append(out, "\n}\n");
    return !json || g_file_set_contents(json, out->str, -1, error);
}

int main(int argc, char **argv)
{
    g_autoptr(GError) error = NULL;
    g_autoptr(GOptionContext) context = g_option_context_new(NULL);
    g_option_context_add_main_entries(context, options, NULL);
    if (!g_option_context_parse(context, &argc, &argv, &error) ||
        !(run ? run_hidden(run, &error) : run_all(argv[0], &error))) {
        fprintf(stderr, "bench: %s\n", error->message);
        return 1;
    }
    return 0;
}
