#include "lazy/lazy.h"

#include "base/alloc.h"
#include "base/error.h"
#include "base/rng.h"
#include "guides/local_width.h"
#include "lazy/fluid_exemplar.h"
#include "lazy/lazy_state.h"
#include "lazy/retrieve.h"
#include "lazy/warp.h"
#include "synth/rest.h"
#include "synth/vote.h"
#include <math.h>
#include <string.h>

#define BAND 2.56f      // sigmas from l = .1 to u = .9 on a straight edge
#define SIGMA_LEAST 1.5 // px, of the style's own border
#define SIGMA_MOST 6
#define OUTER 1.28f // sigmas from the contour out to l
#define ROOM 4      // sigmas of half a width that has a boundary and an interior

/* One level of the target. Coarser ones go before finer ones are made but for their planes. */
typedef struct Level {
    FlFluidPlanes planes; // blurred alpha and the past; until they are packed
    FlFluidPicture picture;
    FlFluidSegments segments;
    FlNnf nnf;
} Level;

struct FlLazy {
    const FlExemplar *exemplar;
    const FlParams *params;
    FlKernels kernels;
    FlFluidWeights weights;
    float sigma_px;
    int width, height, most_levels;
    int n_levels; // of the frame in hand
    uint64_t key;
    FlLazyState last;
    FlRecordingEnd end;
    FlFluidExemplar source;     // of the frame in hand
    Level level[FL_MAX_LEVELS]; // likewise; the planes of level 0 are kept after the frame if it is
                                // inspected
    FlNnf warm;                 // likewise: the carried field; empty in a first frame
    float *motion;              // likewise: 2 per pixel; NULL if there is no motion
    uint16_t *half_width;       // likewise: fl_local_width(), up to ROOM
    uint8_t *presence;          // likewise: of the fluid, 0..255
    bool shows;                 // the frame in hand is inspected when it is painted
    bool wants_terms;           // in the statistics
};

static FlFluidWeights weights_of(const FlParams *params)
{
    const float past = MIN(params->w_temp, (FL_FLUID_WEIGHTS - 1) / 6.0f);
    return (FlFluidWeights){MIN(params->w_bound, FL_FLUID_WEIGHTS - 6 * past), past};
}

static float sigma_of(const FlExemplar *exemplar, const FlParams *params)
{
    const double own = CLAMP(exemplar->border_px / BAND, SIGMA_LEAST, SIGMA_MOST);
    return params->border > 0 ? params->border / BAND : (float)own;
}

float fl_lazy_reach(const FlExemplar *exemplar, const FlParams *params)
{
    return OUTER * sigma_of(exemplar, params) + 1;
}

FlLazy *fl_lazy_new(const FlExemplar *exemplar, const FlParams *params, FlRecordingEnd end,
                    FlSynthSize size, uint64_t seed, GError **error)
{
    g_autoptr(FlLazy) lazy = g_new0(FlLazy, 1);
    lazy->exemplar = exemplar, lazy->params = params, lazy->end = end;
    lazy->width = size.width, lazy->height = size.height;
    lazy->sigma_px = sigma_of(exemplar, params);
    lazy->most_levels = MIN(exemplar->n_levels, fl_levels_of(size.frame_width, size.frame_height));
    lazy->key = fl_hash64(seed);
    fl_kernels_init(&lazy->kernels, fl_cpu_flags());
    lazy->last = (FlLazyState){.width = size.width, .height = size.height};
    return g_steal_pointer(&lazy);
}

static void level_clear(Level *level)
{
    fl_fluid_planes_clear(&level->planes);
    fl_fluid_picture_clear(&level->picture);
    fl_fluid_segments_clear(&level->segments);
    fl_nnf_clear(&level->nnf);
}

static void clear_frame(FlLazy *lazy)
{
    for (int l = 0; l < FL_MAX_LEVELS; l++)
        level_clear(&lazy->level[l]);
    fl_nnf_clear(&lazy->warm);
    g_clear_pointer(&lazy->motion, free);
    g_clear_pointer(&lazy->half_width, free);
    g_clear_pointer(&lazy->presence, free);
}

void fl_lazy_free(FlLazy *lazy)
{
    if (!lazy)
        return;
    clear_frame(lazy);
    fl_fluid_exemplar_clear(&lazy->source);
    fl_lazy_state_forget(&lazy->last);
    g_free(lazy);
}

/* ---- the target ------------------------------------------------------------------------------ */

/* The frame of the exemplar that goes with a frame, which is -1 or more. */
static int frame_in_step(const FlLazy *lazy, int frame)
{
    const FlExemplarLevel *full = &lazy->exemplar->level[0];
    const int n = full->window, last = n - 1;
    if (lazy->end == FL_RECORDING_HOLD)
        return full->first + CLAMP(frame, 0, last);
    if (lazy->end == FL_RECORDING_PING_PONG)
        return full->first + (last > 0 ? last - abs(last - abs(frame) % (2 * last)) : 0);
    return full->first + (frame + n) % n;
}

static bool pack_source(FlLazy *lazy, GError **error)
{
    const int now = lazy->last.frame - 1; // counted from 0; the frame in hand is counted already
    return fl_fluid_exemplar_pack(&lazy->source, lazy->exemplar, frame_in_step(lazy, now),
                                  frame_in_step(lazy, now - 1), lazy->n_levels, lazy->sigma_px,
                                  &lazy->weights, error);
}

static bool find_motion(FlLazy *lazy, const FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    const int reach = (int)(BAND * lazy->sigma_px) + 3;
    return (lazy->motion = fl_alloc(2 * pixels, sizeof(float), "a flow field", error)) &&
           fl_lazy_motion(guides, reach, lazy->motion, error);
}

/* Half the width of the part around a pixel, as a share of what leaves room for all of a boundary;
 * at most 1. */
static float room(const FlLazy *lazy, size_t p)
{
    const float wide = (float)fl_width_cap(ROOM * lazy->sigma_px);
    return lazy->half_width[p] > 0 ? (float)lazy->half_width[p] / wide : 1;
}

static bool find_thin_parts(FlLazy *lazy, const FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    bool narrow;
    return (lazy->half_width =
                fl_alloc_unset(pixels, sizeof *lazy->half_width, "local widths", error)) &&
           fl_local_width(guides->distance, NULL, lazy->width, lazy->height, ROOM * lazy->sigma_px,
                          lazy->half_width, &narrow, error);
}

/* The blurred mask [L15 §4.2]. */
static bool find_edge(FlLazy *lazy, const uint8_t *mask, GError **error)
{
    FlFluidPlanes *planes = &lazy->level[0].planes;
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    const int end = lazy->last.valid ? FL_FLUID_PLANES : FL_FLUID_PLANE_PAST;
    if (!fl_fluid_planes_init(planes, lazy->width, lazy->height, FL_FLUID_PLANE_EDGE, end, error))
        return false;
    for (size_t p = 0; p < pixels; p++)
        planes->plane[FL_FLUID_PLANE_EDGE][p] = (float)mask[p] / 255;
    return fl_fluid_planes_blur(planes, lazy->sigma_px, error);
}

/* In thin parts, where the blurred mask is faint all over, it becomes what it would be beside a
 * straight edge if it were blurred so little that there is an interior. */
static void narrow_edge(const FlLazy *lazy, const float *distance)
{
    float *edge = lazy->level[0].planes.plane[FL_FLUID_PLANE_EDGE];
    for (size_t p = 0; p < (size_t)lazy->width * (size_t)lazy->height; p++) {
        const float share = room(lazy, p), sigma = share * lazy->sigma_px;
        const float narrow = .5f + .5f * erff(distance[p] / (sigma * (float)G_SQRT2));
        edge[p] = share < 1 ? narrow + share * (edge[p] - narrow) : edge[p];
    }
}

#define FADE 2.5f // px inside the limit of the fluid

/* Narrows the edge, and finds how much of each pixel is fluid: 255 inside, falling to the limit
 * from which on there are no matches. That goes with the blurred mask, not with the matches: a side
 * that moves slowly would go out row by row. */
static bool find_limits(FlLazy *lazy, const float *distance, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    const float *edge = lazy->level[0].planes.plane[FL_FLUID_PLANE_EDGE];
    narrow_edge(lazy, distance);
    if (!(lazy->presence = fl_alloc_unset(pixels, 1, "a mask", error)))
        return false;
    for (size_t p = 0; p < pixels; p++) {
        const float slope = .1755f / (room(lazy, p) * lazy->sigma_px); // a px, of a straight limit
        const float share = (edge[p] - FL_FLUID_LOWER) / (FADE * slope);
        lazy->presence[p] = (uint8_t)ceilf(255 * CLAMP(share, 0, 1));
    }
    return true;
}

/* The last output and field in the place where they are now; they go themselves. */
static bool carry_past(FlLazy *lazy, GError **error)
{
    FlLazyState *last = &lazy->last;
    if (!fl_fluid_warp(&last->past, lazy->sigma_px, lazy->motion, last->frame, &lazy->kernels,
                       &lazy->level[0].planes, error))
        return false;
    g_clear_pointer(&last->past.rgba, free);
    if (!fl_nnf_init(&lazy->warm, lazy->width, lazy->height, error))
        return false;
    if (!fl_fluid_carry(&last->past.nnf, lazy->motion, &lazy->level[0].planes,
                        &lazy->source.level[0].picture, &lazy->warm, error))
        return false;
    if (!(lazy->params->motion_blur > 0))
        g_clear_pointer(&lazy->motion, free);
    return true;
}

static FlRestRule rest_rule(const FlLazy *lazy)
{
    return (FlRestRule){lazy->exemplar->border_px, lazy->params->flow_still};
}

/* All that is needed of the guides, which then may go. */
static bool take_guides(FlLazy *lazy, FlGuides *guides, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    g_autofree uint8_t *mask = fl_alloc(pixels, 1, "a mask", error);
    g_autofree uint8_t *shape = mask ? fl_alloc(pixels, 1, "a mask", error) : NULL;
    if (!shape || (lazy->last.valid && !find_motion(lazy, guides, error)))
        return false;
    memcpy(mask, guides->mask, pixels);
    const FlRestRule rule = rest_rule(lazy);
    fl_rest_shape(guides, &rule, shape);
    if (!find_edge(lazy, mask, error) || (lazy->last.valid && !carry_past(lazy, error)) ||
        !find_limits(lazy, guides->distance, error))
        return false;
    if (guides->disposable)
        fl_guides_clear(guides);
    fl_lazy_state_forget(&lazy->last);
    lazy->last.past.mask = g_steal_pointer(&mask);
    lazy->last.shape = g_steal_pointer(&shape);
    return true;
}

/* ---- a level --------------------------------------------------------------------------------- */

/* The last field in the size of a level; empty in a first frame. */
static bool warm_field(FlLazy *lazy, int l, FlNnf *warm, GError **error)
{
    if (l == 0)
        *warm = lazy->warm, lazy->warm = (FlNnf){0};
    if (l == 0 || !lazy->warm.match)
        return true;
    const FlFluidPlanes *planes = &lazy->level[l].planes;
    if (!fl_nnf_init(warm, planes->width, planes->height, error))
        return false;
    fl_nnf_downscale(&lazy->warm, l, &lazy->source.level[l].voted, warm);
    return true;
}

static FlMatch random_match(const FlFluidLevel *source, int segment, uint64_t key)
{
    const FlFluidSegments *s = &source->segments;
    FlRng rng = {key};
    const uint32_t p = s->place[segment][fl_rng_below(&rng, (uint32_t)s->n[segment])];
    const uint32_t width = (uint32_t)source->picture.width;
    return (FlMatch){.x_16 = (uint16_t)(16 * (p % width)), .y_16 = (uint16_t)(16 * (p / width))};
}

/* Gives each pixel of the segments a match: the carried one, else the present one, else a random
 * one. Clears the matches elsewhere. */
static void complete(const FlLazy *lazy, int l, const FlNnf *warm, uint64_t key)
{
    const Level *level = &lazy->level[l];
    const size_t pixels = (size_t)level->nnf.width * (size_t)level->nnf.height;
    const float *edge = level->planes.plane[FL_FLUID_PLANE_EDGE];
    for (size_t p = 0; p < pixels; p++)
        if (!(edge[p] > FL_FLUID_LOWER))
            level->nnf.match[p].frame = FL_NO_MATCH;
    for (int s = 0; s < 2; s++)
        for (size_t k = 0; k < level->segments.n[s]; k++) {
            const uint32_t p = level->segments.place[s][k];
            FlMatch *m = &level->nnf.match[p];
            if (warm->match && warm->match[p].frame != FL_NO_MATCH)
                *m = warm->match[p];
            if (m->frame == FL_NO_MATCH)
                *m = random_match(&lazy->source.level[l], s, fl_key(key, p));
        }
}

/* The first field of a level, from the coarser one, which goes. */
static bool start_field(FlLazy *lazy, int l, uint64_t key, GError **error)
{
    Level *level = &lazy->level[l];
    const FlFluidPlanes *planes = &level->planes;
    g_auto(FlNnf) warm = {0};
    if (!warm_field(lazy, l, &warm, error) ||
        !fl_fluid_segments_init(&level->segments, planes, error) ||
        (lazy->source.level[l].segments.n[1] == 0 &&
         !fl_fluid_segments_merge(&level->segments, error)) ||
        !fl_nnf_init(&level->nnf, planes->width, planes->height, error))
        return false;
    if (l + 1 < lazy->n_levels) {
        g_auto(FlBlocks) all = {0};
        fl_blocks_init_full(&all, planes->width, planes->height);
        fl_nnf_upscale(&level[1].nnf, &lazy->source.level[l].voted, &all, &level->nnf);
        level_clear(&level[1]);
    }
    complete(lazy, l, &warm, key);
    return true;
}

/* Fills pixels without votes with bare paper. */
static void fill_paper(const FlExemplar *exemplar, int pixels, float *rgba)
{
    for (int p = 0; p < pixels; p++) {
        for (int c = 0; c < 3; c++)
            rgba[4 * p + c] = exemplar->cut_out ? 0 : exemplar->paper[c] / 255.0f;
        rgba[4 * p + 3] = 0;
    }
}

/*
 * Every level begins with X^ where there was fluid; the coarser level counts for what is new. From
 * the coarser field alone, fine texture stood still: a motion of 2 px is less than a pixel of a
 * coarse level, whose patches stay, and X counts more than X^ by 1 / lambda. Measured: the texture
 * of a translation moved by 0 of 2 px with lambda .5 and four levels.
 */
static void start_from_past(const FlFluidPlanes *planes, int y, float *rgba)
{
    const size_t row = (size_t)y * (size_t)planes->width;
    for (size_t x = 0; x < (size_t)planes->width; x++)
        for (size_t c = 0; c < 4; c++) {
            const float w = planes->plane[FL_FLUID_PLANE_WEIGHT][row + x];
            const float past = planes->plane[FL_FLUID_PLANE_PAST + c][row + x];
            rgba[4 * x + c] += w * (past - rgba[4 * x + c]);
        }
}

static void store_row(const float *rgba, int n, uint16_t *output)
{
    for (int k = 0; k < n; k++)
        output[k] = (uint16_t)(rgba[k] * FL_FLUID_DEPTH + .5f);
}

/* A row of votes into an output of 4 values a pixel; NULL: into the level's picture. */
static void take_row(const Level *level, const float *rgba, int y, uint16_t *output)
{
    const int values = 4 * level->nnf.width;
    if (output)
        store_row(rgba, values, output + (size_t)y * (size_t)values);
    else
        fl_fluid_picture_pack_row(rgba, y, &level->picture);
}

/* past: where the level begins; or NULL. */
static void vote(const FlLazy *lazy, int l, const FlFluidPlanes *past, uint16_t *output)
{
    const Level *level = &lazy->level[l];
    const int width = level->nnf.width, height = level->nnf.height;
#pragma omp parallel
    {
        g_autofree float *strip = g_new(float, 4 * (size_t)width * FL_VOTE_ROWS);
#pragma omp for schedule(dynamic, 1)
        for (int first = 0; first < height; first += FL_VOTE_ROWS) {
            fill_paper(lazy->exemplar, width * FL_VOTE_ROWS, strip);
            fl_vote_rows(&level->nnf, &lazy->source.level[l].voted, &lazy->kernels,
                         lazy->params->vote_sharpness, 4, first, strip);
            for (int y = first; y < MIN(first + FL_VOTE_ROWS, height); y++) {
                float *rgba = strip + 4 * (size_t)width * (size_t)(y - first);
                if (past && past->plane[FL_FLUID_PLANE_WEIGHT])
                    start_from_past(past, y, rgba);
                take_row(level, rgba, y, output);
            }
        }
    }
}

/* The target as it is before the first round. */
static bool start_picture(FlLazy *lazy, int l, GError **error)
{
    Level *level = &lazy->level[l];
    FlFluidPlanes *planes = &level->planes;
    if (!fl_fluid_picture_init(&level->picture, planes->width, planes->height, error))
        return false;
    fl_fluid_picture_pack(planes, &lazy->weights, &level->picture);
    vote(lazy, l, planes, NULL);
    if (l > 0 || !lazy->shows)
        fl_fluid_planes_clear(planes);
    return true;
}

/* Border, then interior; on a level without separate ones the first is all. Drafts do not turn
 * patches, and their finest level below others takes nearest neighbours: these have used the style
 * evenly. */
static bool retrieve(FlLazy *lazy, int l, uint64_t key, FlLevelStats *stats, GError **error)
{
    Level *level = &lazy->level[l];
    const FlFluidLevel *source = &lazy->source.level[l];
    const FlParams *params = lazy->params;
    const bool quick = params->half_size && l == 0 && lazy->n_levels > 1;
    stats->energy = 0;
    for (int s = 0; s < 2; s++) {
        const bool border = s == 0 && source->segments.n[1] > 0;
        const bool freely = quick || (border ? params->w_uni < 1 : params->w_uni <= 0);
        const FlRetrieval in = {.source = source->picture,
                                .target = level->picture,
                                .sources = source->segments.place[s],
                                .targets = level->segments.place[s],
                                .n_sources = source->segments.n[s],
                                .n_targets = level->segments.n[s],
                                .turns = params->rotate && !params->half_size,
                                .uniform = freely                   ? FL_UNIFORM_OFF
                                           : params->uniform_blocks ? FL_UNIFORM_AUTO
                                                                    : FL_UNIFORM_PATCH,
                                .sweeps = MAX(params->finest_sweeps, 1),
                                .key = fl_key(key, (uint64_t)s),
                                .distance = lazy->kernels.fluid_distance};
        FlRetrieved done;
        if (!fl_retrieve(&in, &level->nnf, &done, error))
            return false;
        stats->counts.tried += done.evaluations;
        stats->energy += done.energy;
    }
    stats->energy /= MAX(stats->pixels, 1);
    return true;
}

void fl_lazy_measure(FlLazy *lazy, bool terms)
{
    lazy->wants_terms = terms;
}

static double square(double v)
{
    return v * v;
}

/* Adds a pixel's terms of (9), over its patch: of the colours, the blurred alpha and the past. */
static void add_terms(const FlFluidPicture *source, const FlFluidPicture *target, uint32_t place,
                      FlMatch match, FlLevelStats *stats)
{
    const int width = target->width, x = (int)place % width, y = (int)place / width;
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        const int dx = k % FL_PATCH - FL_PATCH_RADIUS, dy = k / FL_PATCH - FL_PATCH_RADIUS;
        int sx, sy;
        fl_unrotate(match.theta, dx, dy, &sx, &sy);
        const int column = (match.x_16 + sx) / 16, row = (match.y_16 + sy) / 16;
        const int16_t *s = source->pixel[row * source->pitch + column].c;
        const int16_t *t = target->pixel[(y + dy) * target->pitch + x + dx].c;
        const double weight = (double)t[FL_FLUID_WEIGHT] / INT16_MAX;
        for (int c = FL_FLUID_R; c <= FL_FLUID_EDGE; c++)
            *(c < FL_FLUID_EDGE ? &stats->texture : &stats->bound) += square(s[c] - t[c]);
        for (int c = FL_FLUID_PAST; c <= FL_FLUID_PAST_A; c++)
            stats->temporal += square(weight * (s[c] - t[c]));
    }
}

static void measure_terms(const FlLazy *lazy, int l, FlLevelStats *stats)
{
    const Level *level = &lazy->level[l];
    const double unit = (double)FL_FLUID_ONE * FL_FLUID_ONE * MAX(stats->pixels, 1);
    for (int s = 0; s < 2; s++)
        for (size_t k = 0; k < level->segments.n[s]; k++) {
            const uint32_t place = level->segments.place[s][k];
            add_terms(&lazy->source.level[l].picture, &level->picture, place,
                      level->nnf.match[place], stats);
        }
    stats->texture /= unit, stats->bound /= unit, stats->temporal /= unit;
}

static bool run_level(FlLazy *lazy, int l, FlLevelStats *stats, GError **error)
{
    const Level *level = &lazy->level[l];
    const FlParams *params = lazy->params;
    const uint64_t key = fl_key(fl_key(lazy->key, (uint64_t)lazy->last.frame), (uint64_t)l);
    const int from_coarsest = lazy->n_levels - 1 - l;
    if (!start_field(lazy, l, fl_key(key, 1), error) || !start_picture(lazy, l, error))
        return false;
    *stats = (FlLevelStats){.width = level->nnf.width, .height = level->nnf.height};
    stats->pixels = (int)(level->segments.n[0] + level->segments.n[1]);
    stats->rounds =
        l == 0 ? params->finest_rounds : fl_list_at(&params->opt_iterations, from_coarsest);
    for (int round = 0; round < stats->rounds; round++) {
        if (round > 0)
            vote(lazy, l, NULL, NULL);
        if (!retrieve(lazy, l, fl_key(key, 2 + (uint64_t)round), stats, error))
            return false;
    }
    if (lazy->wants_terms)
        measure_terms(lazy, l, stats);
    return true;
}

/* ---- a frame --------------------------------------------------------------------------------- */

static bool run_levels(FlLazy *lazy, FlFrameStats *stats, GError **error)
{
    stats->n_levels = lazy->n_levels;
    for (int l = lazy->n_levels - 1; l >= 0; l--) {
        const gint64 start = g_get_monotonic_time();
        if (!run_level(lazy, l, &stats->level[l], error))
            return false;
        stats->level[l].seconds = fl_seconds_since(start);
        stats->seconds_search += stats->level[l].seconds;
    }
    return true;
}

static bool prepare(FlLazy *lazy, FlGuides *guides, GError **error)
{
    if (!pack_source(lazy, error) || !take_guides(lazy, guides, error))
        return false;
    for (int l = 1; l < lazy->n_levels; l++)
        if (!fl_fluid_planes_halve(&lazy->level[l - 1].planes, &lazy->level[l].planes, error))
            return false;
    return true;
}

/* Keeps the output, from which the next frame is warped. */
static bool remember(FlLazy *lazy, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    FlFluidPast *past = &lazy->last.past;
    Level *finest = &lazy->level[0];
    fl_fluid_picture_clear(&finest->picture);
    fl_fluid_segments_clear(&finest->segments);
    if (!(past->rgba = fl_alloc(4 * pixels, sizeof *past->rgba, "a picture", error)))
        return false;
    vote(lazy, 0, NULL, past->rgba);
    past->nnf = finest->nnf, finest->nnf = (FlNnf){0};
    for (size_t p = 0; p < pixels; p++)
        if (past->nnf.match[p].frame != FL_NO_MATCH)
            past->nnf.match[p].frame = (int16_t)lazy->source.frame;
    lazy->last.valid = true;
    return true;
}

#define AROUND 4 // px from which faint paint takes its colour in thin parts

/* The colours of a cut-out as they are, where rgba has them times its alpha: where that is 0, the
 * paper's. Faint paint has hardly a colour of its own, and thin parts show it by the alpha of the
 * drawing: it takes that of stronger paint around, by a share that is 0 where there is room. */
static void straight(const FlLazy *lazy, const uint16_t *rgba, int x, int y, float thin,
                     uint8_t rgb[3])
{
    const uint16_t *own = rgba + 4 * ((size_t)y * (size_t)lazy->width + (size_t)x);
    const float faint = 1 - (float)own[3] / 65535, weight = .1f * thin * faint * faint;
    float sum[4] = {own[0], own[1], own[2], own[3]};
    for (int v = y - AROUND; weight > 0 && v <= y + AROUND; v += 2)
        for (int u = x - AROUND; u <= x + AROUND; u += 2) {
            const int column = CLAMP(u, 0, lazy->width - 1), row = CLAMP(v, 0, lazy->height - 1);
            const uint16_t *near = rgba + 4 * ((size_t)row * (size_t)lazy->width + (size_t)column);
            for (int c = 0; c < 4; c++)
                sum[c] += weight * near[c];
        }
    for (int c = 0; c < 3; c++)
        rgb[c] = sum[3] > 0 ? (uint8_t)(255 * MIN(sum[c], sum[3]) / sum[3] + .5f)
                            : lazy->exemplar->paper[c];
}

/* The last output, which fades out where matches end: there would be steps, and specks beside the
 * fluid, which come from patches of its edge. The next frame is warped from the one with them,
 * whose edge is not mixed with paper. */
static uint16_t *with_smooth_limits(const FlLazy *lazy, GError **error)
{
    const FlExemplar *exemplar = lazy->exemplar;
    const FlFluidPast *past = &lazy->last.past;
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    uint16_t *rgba = fl_alloc(4 * pixels, sizeof *rgba, "a picture", error);
    if (!rgba)
        return NULL;
    for (size_t p = 0; p < pixels; p++) {
        const float share = (float)lazy->presence[p] / 255;
        for (size_t c = 0; c < 4; c++)
            if (exemplar->cut_out || c == 3)
                rgba[4 * p + c] = (uint16_t)(share * (float)past->rgba[4 * p + c] + .5f);
            else
                rgba[4 * p + c] =
                    share > 0 ? past->rgba[4 * p + c] : (uint16_t)(257 * exemplar->paper[c]);
    }
    return rgba;
}

/* The last output, blurred along the motion where that is asked for. */
static bool write_output(const FlLazy *lazy, uint8_t *rgb, uint8_t *alpha, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    const float shutter = lazy->params->motion_blur;
    g_autofree uint16_t *shown = with_smooth_limits(lazy, error), *blurred = NULL;
    if (!shown)
        return false;
    if (shutter > 0 && lazy->motion) {
        if (!(blurred = fl_motion_blur(shown, lazy->motion, lazy->width, lazy->height,
                                       lazy->exemplar->cut_out, shutter, error)))
            return false;
    }
    const uint16_t *rgba = blurred ? blurred : shown;
    for (size_t p = 0; p < pixels; p++) {
        const int x = (int)(p % (size_t)lazy->width), y = (int)(p / (size_t)lazy->width);
        const float own = room(lazy, p), drawn = (float)lazy->last.past.mask[p];
        if (lazy->exemplar->cut_out)
            straight(lazy, rgba, x, y, 1 - own, rgb + 3 * p);
        else
            for (size_t c = 0; c < 3; c++)
                rgb[3 * p + c] = (uint8_t)((rgba[4 * p + c] + 128) / 257);
        if (alpha)
            alpha[p] = (uint8_t)(drawn + own * ((float)rgba[4 * p + 3] / 257 - drawn) + .5f);
    }
    return true;
}

static void write_nothing(FlLazy *lazy, uint8_t *rgb, uint8_t *alpha)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    for (size_t p = 0; p < pixels; p++)
        memcpy(rgb + 3 * p, lazy->exemplar->paper, 3);
    if (alpha)
        memset(alpha, 0, pixels);
    fl_lazy_state_forget(&lazy->last);
}

/* Returns: true if the region rests. A video exemplar plays on while the drawing is held. */
static bool holds_still(const FlLazy *lazy, const FlGuides *guides)
{
    const FlRestRule rule = rest_rule(lazy);
    return lazy->params->rest && lazy->last.valid && lazy->exemplar->level[0].window == 1 &&
           fl_rests(guides, &rule, lazy->last.shape, NULL);
}

static bool paint(FlLazy *lazy, FlGuides *guides, uint8_t *rgb, uint8_t *alpha, FlFrameStats *stats,
                  GError **error)
{
    clear_frame(lazy);
    lazy->last.frame++;
    lazy->weights = weights_of(lazy->params);
    // drafts that go on from a frame search the finest level alone, where its field was carried
    lazy->n_levels = lazy->params->half_size && lazy->last.valid ? 1 : lazy->most_levels;
    if (fl_guides_box(guides, FL_INSIDE).width == 0) {
        write_nothing(lazy, rgb, alpha);
        return true;
    }
    return find_thin_parts(lazy, guides, error) &&
           (holds_still(lazy, guides)
                ? find_edge(lazy, lazy->last.past.mask, error) &&
                      find_limits(lazy, guides->distance, error)
                : (prepare(lazy, guides, error) && run_levels(lazy, stats, error) &&
                   remember(lazy, error))) &&
           write_output(lazy, rgb, alpha, error);
}

bool fl_lazy_frame(FlLazy *lazy, FlGuides *guides, uint8_t *rgb, uint8_t *alpha,
                   FlFrameStats *stats, FlSynthView *view, GError **error)
{
    FlFrameStats no_stats = {0};
    FlFrameStats *const s = stats ? stats : &no_stats;
    *s = (FlFrameStats){0};
    lazy->shows = view != NULL;
    const bool done = paint(lazy, guides, rgb, alpha, s, error);
    if (view)
        *view = (FlSynthView){{0, 0, lazy->width, lazy->height},
                              done && lazy->last.valid ? &lazy->last.past.nnf : NULL,
                              NULL,
                              NULL};
    else
        clear_frame(lazy);
    return done;
}

bool fl_lazy_guide_pairs(const FlLazy *lazy, FlGuidePairs *pairs, GError **error)
{
    const FlFluidExemplar *source = &lazy->source;
    g_auto(FlFluidPlanes) planes = {0};
    return fl_fluid_exemplar_planes(lazy->exemplar, source->frame, source->before, lazy->sigma_px,
                                    &planes, error) &&
           fl_lazy_pairs(&planes, &lazy->level[0].planes, &lazy->weights, lazy->exemplar->paper,
                         lazy->exemplar->cut_out, pairs, error);
}

GBytes *fl_lazy_save(FlLazy *lazy, GError **error)
{
    return fl_lazy_state_pack(&lazy->last, error);
}

bool fl_lazy_load(FlLazy *lazy, GBytes *state, GError **error)
{
    return fl_lazy_state_unpack(&lazy->last, state, &lazy->exemplar->level[0], error);
}
