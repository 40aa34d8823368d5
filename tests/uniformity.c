/*
 * The scheme of the uniformity term beside the papers' own: exact Omega*, strictly one after the
 * other.
 *
 * usage: uniformity STYLE_DIR
 *
 * Both search the full-size level of a disc from the same random field, guides only, with the same
 * sweeps. The sequential search keeps Omega* as [F21 §3.5] defines it, by pixel and frame, brought
 * up to date with every match. Both fields are judged by that exact map. Printed:
 *   data      mean data energy (guides and direction)
 *   omega     mean of the exact Omega* over an even use, the pixel's own use left out
 *   p50, p95, max  of the exact use of exemplar pixels in use, over an even use
 *   entropy   of the use of exemplar pixels, as a share of an even use
 */
#include "base/rng.h"
#include "default_params.h"
#include "synth/patchmatch.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define SIDE 120
#define SWEEPS 6

typedef struct Omega {
    const FlExemplarLevel *level;
    int radius, *use; // cuboids over each exemplar pixel, n_frames * height * width
    double even[FL_SEGMENTS];
} Omega;

/* Adds `sign` to every pixel that the match's cuboid covers. */
static void cover(Omega *o, FlMatch m, int sign)
{
    const FlExemplarLevel *e = o->level;
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        int dx, dy;
        fl_unrotate(m.theta, fl_patch_offsets[k][0], fl_patch_offsets[k][1], &dx, &dy);
        const int x = (m.x_16 + dx + 8) >> 4, y = (m.y_16 + dy + 8) >> 4;
        if (x < 0 || y < 0 || x >= e->width || y >= e->height)
            continue;
        for (int t = MAX(m.frame - o->radius, 0); t <= MIN(m.frame + o->radius, e->n_frames - 1);
             t++)
            o->use[((size_t)t * e->height + y) * e->width + x] += sign;
    }
}

/* Omega* summed over the patch, over n² times an even use. */
static double omega_of(const Omega *o, FlSegment segment, FlMatch m)
{
    const FlExemplarLevel *e = o->level;
    double sum = 0;
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        int dx, dy;
        fl_unrotate(m.theta, fl_patch_offsets[k][0], fl_patch_offsets[k][1], &dx, &dy);
        const int x = CLAMP((m.x_16 + dx + 8) >> 4, 0, e->width - 1);
        const int y = CLAMP((m.y_16 + dy + 8) >> 4, 0, e->height - 1);
        sum += o->use[((size_t)m.frame * e->height + y) * e->width + x];
    }
    return sum / FL_PATCH_PIXELS / o->even[segment];
}

static void omega_init(Omega *o, const FlSearch *search)
{
    const FlExemplarLevel *e = search->level;
    const int r = search->params->uni_radius;
    *o = (Omega){.level = e, .radius = r};
    o->use = g_new0(int, (size_t)e->n_frames * e->height * e->width);
    for (int s = FL_SEGMENT_BORDER; s < FL_SEGMENTS; s++)
        o->even[s] = FL_PATCH_PIXELS * (2.0 * r + 1) * MAX(search->target->n_inside[s], 1) /
                     MAX((double)e->n_valid[s], 1);
    for (int p = 0; p < SIDE * SIDE; p++)
        if (search->nnf->match[p].frame != FL_NO_MATCH)
            cover(o, search->nnf->match[p], 1);
}

typedef struct Visit {
    const FlSearch *search;
    Omega *omega;
    int x, y;
    FlMatch best;
    double cost;
} Visit;

/* The pixel's own cuboid has been taken out of the map. */
static double cost_of(const Visit *v, FlMatch m)
{
    const FlSearch *s = v->search;
    return fl_match_cost(s, v->x, v->y, m) / s->scale->unit +
           s->params->w_uni * omega_of(v->omega, s->target->segment[(size_t)v->y * SIDE + v->x], m);
}

static void try_match(Visit *v, FlMatch m)
{
    if (m.frame == FL_NO_MATCH ||
        fl_exemplar_at(v->search->level, fl_match_x(m), fl_match_y(m), m.frame)->c[FL_CH_SEGMENT] !=
            v->search->target->segment[(size_t)v->y * SIDE + v->x])
        return;
    const double cost = cost_of(v, m);
    if (cost < v->cost)
        v->best = m, v->cost = cost;
}

static void try_neighbours(Visit *v)
{
    static const int side[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};
    for (int k = 0; k < 4; k++) {
        const int x = v->x + side[k][0], y = v->y + side[k][1];
        if (x < 0 || y < 0 || x >= SIDE || y >= SIDE)
            continue;
        const FlMatch m = v->search->nnf->match[y * SIDE + x];
        if (m.frame != FL_NO_MATCH)
            try_match(v, fl_match_moved(m, -side[k][0], -side[k][1], v->search->level));
    }
}

static int within(FlRng *rng, int centre, double radius, int size)
{
    const int low = MAX(centre - (int)radius, 0), high = MIN(centre + (int)radius, size - 1);
    return low + (int)fl_rng_below(rng, (uint32_t)(high - low + 1));
}

static void try_random(Visit *v, uint64_t key)
{
    const FlExemplarLevel *e = v->search->level;
    FlRng rng = {key};
    for (double share = 1; share * MAX(e->width, e->height) >= 1;
         share *= v->search->params->patchmatch_alpha) {
        const int x = within(&rng, fl_match_x(v->best), share * e->width, e->width);
        const int y = within(&rng, fl_match_y(v->best), share * e->height, e->height);
        FlMatch m = {.x_16 = (uint16_t)(16 * x), .y_16 = (uint16_t)(16 * y)};
        m.frame = (int16_t)within(&rng, v->best.frame, share * e->n_frames + 1, e->n_frames);
        m.theta = (uint8_t)(v->search->target->angle[v->y * SIDE + v->x] -
                            fl_exemplar_at(e, x, y, m.frame)->c[FL_CH_ANGLE]);
        try_match(v, m);
        m.theta += 128;
        try_match(v, m);
    }
}

static void search_in_order(const FlSearch *search, Omega *omega)
{
    for (int sweep = 0; sweep < SWEEPS; sweep++)
        for (int k = 0; k < SIDE * SIDE; k++) {
            const int p = sweep & 1 ? SIDE * SIDE - 1 - k : k;
            FlMatch *m = &search->nnf->match[p];
            if (m->frame == FL_NO_MATCH)
                continue;
            cover(omega, *m, -1);
            Visit v = {search, omega, p % SIDE, p / SIDE, *m, 0};
            v.cost = cost_of(&v, *m);
            try_neighbours(&v);
            try_random(&v, fl_key(fl_key(7, (uint64_t)sweep), (uint64_t)p));
            *m = v.best;
            cover(omega, *m, 1);
        }
}

static int by_value(const void *a, const void *b)
{
    return *(const int *)a - *(const int *)b;
}

/* Judges search->nnf by the exact map. */
static void report(const char *name, const FlSearch *search)
{
    Omega o;
    omega_init(&o, search);
    const size_t pixels = (size_t)o.level->n_frames * o.level->height * o.level->width;
    double data = 0, omega = 0, uses = 0, entropy = 0;
    int n = 0;
    for (int p = 0; p < SIDE * SIDE; p++) {
        const FlMatch m = search->nnf->match[p];
        if (m.frame == FL_NO_MATCH)
            continue;
        cover(&o, m, -1);
        omega += omega_of(&o, search->target->segment[p], m);
        cover(&o, m, 1);
        data += fl_match_cost(search, p % SIDE, p / SIDE, m) / search->scale->unit, n++;
    }
    qsort(o.use, pixels, sizeof(int), by_value);
    size_t first = 0;
    while (first < pixels && o.use[first] == 0)
        first++;
    for (size_t p = first; p < pixels; p++)
        uses += o.use[p];
    for (size_t p = first; p < pixels; p++)
        entropy -= o.use[p] / uses * log(o.use[p] / uses);
    const size_t used = pixels - first;
    const double paint =
        (double)(o.level->n_valid[FL_SEGMENT_BORDER] + o.level->n_valid[FL_SEGMENT_INTERIOR]);
    const double even = uses / paint;
    printf("%-12s data %.3f  omega %.3f  sum %.3f  p50 %.2f  p95 %.2f  max %.1f  entropy %.4f\n",
           name, data / n, omega / n, data / n + search->params->w_uni * omega / n,
           o.use[first + used / 2] / even, o.use[first + used * 95 / 100] / even,
           o.use[pixels - 1] / even, entropy / log(paint));
    g_free(o.use);
}

static bool disc(void *data, int frame, uint8_t *coverage, GError **error)
{
    for (int p = 0; p < SIDE * SIDE; p++) {
        const double inside = 45 - hypot(p % SIDE - 56 - 2 * frame, p / SIDE - 60);
        coverage[p] = (uint8_t)(CLAMP(inside + 0.5, 0, 1) * 255);
    }
    return true;
}

static bool make_target(FlTarget *target, const FlExemplar *exemplar, const FlParams *params,
                        GError **error)
{
    const FlGuideParams how = fl_guide_params(params);
    const FlGuideSource source = {SIDE, SIDE, 4, disc, NULL, NULL};
    g_autoptr(FlGuideSequence) guides = fl_guide_sequence_new(&source, &how, error);
    g_auto(FlGuides) now = {0};
    return guides && fl_guides_init(&now, SIDE, SIDE, error) &&
           fl_guide_sequence_get(guides, 1, &now, error) &&
           fl_target_init(target, &now, params, (FlRect){0, 0, SIDE, SIDE}, 1, exemplar, error);
}

static void randomise(FlNnf *nnf, const FlSearch *search)
{
    for (size_t p = 0; p < SIDE * SIDE; p++)
        nnf->match[p].frame = FL_NO_MATCH;
    fl_nnf_repair(nnf, search->level, search->target, true, 3);
}

static bool compare(const FlStyle *style, FlParams *params, GError **error)
{
    g_autoptr(FlExemplar) exemplar = fl_exemplar_new(style, params, error);
    g_auto(FlTarget) target = {0};
    g_auto(FlNnf) nnf = {0};
    g_auto(FlOccurrence) map = {0};
    g_autofree uint32_t *cost = g_new(uint32_t, SIDE * SIDE);
    FlCostScale scale;
    FlKernels kernels;
    fl_cost_scale_init(&scale, params);
    fl_kernels_init(&kernels, fl_cpu_flags());
    if (!exemplar || !make_target(&target, exemplar, params, error) ||
        !fl_nnf_init(&nnf, SIDE, SIDE, error) ||
        !fl_occurrence_init(&map, &exemplar->level[0], &target.level[0], params, &scale, error))
        return false;
    FlSearch search = {.level = &exemplar->level[0],
                       .target = &target.level[0],
                       .params = params,
                       .scale = &scale,
                       .w_coh = params->w_coh,
                       .kernels = &kernels,
                       .nnf = &nnf,
                       .cost = cost,
                       .map = &map,
                       .key = 7};
    fl_target_blend(&target.level[0], params, &scale, 0);
    randomise(&nnf, &search);
    report("random", &search);
    Omega omega;
    omega_init(&omega, &search);
    search_in_order(&search, &omega);
    g_free(omega.use);
    report("sequential", &search);
    randomise(&nnf, &search);
    fl_occurrence_count(&map, &nnf, search.target);
    fl_search_costs(&search, NULL);
    fl_search_run(&search, SWEEPS);
    report("tiles", &search);
    params->w_uni = 0;
    fl_occurrence_clear(&map);
    if (!fl_occurrence_init(&map, search.level, search.target, params, &scale, error))
        return false;
    randomise(&nnf, &search);
    fl_search_costs(&search, NULL);
    fl_search_run(&search, SWEEPS);
    report("w-uni 0", &search);
    return true;
}

int main(int argc, char **argv)
{
    g_autoptr(GError) error = NULL;
    g_autofree FlParams *params = default_params();
    params->w_coh = 0;
    g_autoptr(FlStyle) style = fl_style_load(argc > 1 ? argv[1] : "", &error);
    if (style && compare(style, params, &error))
        return 0;
    fprintf(stderr, "uniformity: %s\n", error->message);
    return 1;
}
