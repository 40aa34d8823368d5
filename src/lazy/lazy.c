#include "lazy/lazy.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "lazy/fluid_exemplar.h"
#include "lazy/lazy_pairs.h"
#include "lazy/lazy_state.h"
#include "lazy/motion_blur.h"
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

/* One level of the target. */
typedef struct Level {
    FlFluidPlanes planes;
    FlFluidPicture picture;
    FlFluidSegments segments;
    FlNnf nnf, warm; // warm: the carried field in this size; empty in a first frame
    float *rgba;     // X, 4 per pixel
} Level;

struct FlLazy {
    const FlExemplar *exemplar;
    const FlParams *params;
    FlKernels kernels;
    FlFluidWeights weights;
    float sigma_px;
    int width, height, n_levels;
    uint64_t key;
    FlLazyState last;
    FlFluidExemplar source;     // of the frame in hand
    Level level[FL_MAX_LEVELS]; // likewise
    float *motion;              // likewise, 2 per pixel
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
    return OUTER * sigma_of(exemplar, params) + 2 * FL_PATCH_RADIUS; // a patch's corner
}

FlLazy *fl_lazy_new(const FlExemplar *exemplar, const FlParams *params, FlSynthSize size,
                    uint64_t seed, GError **error)
{
    g_autoptr(FlLazy) lazy = g_new0(FlLazy, 1);
    const size_t pixels = (size_t)size.width * (size_t)size.height;
    lazy->exemplar = exemplar, lazy->params = params;
    lazy->width = size.width, lazy->height = size.height;
    lazy->weights = weights_of(params);
    lazy->sigma_px = sigma_of(exemplar, params);
    lazy->n_levels = MIN(exemplar->n_levels, fl_levels_of(size.frame_width, size.frame_height));
    lazy->key = fl_hash64(seed);
    fl_kernels_init(&lazy->kernels, fl_cpu_flags());
    if (!(lazy->motion = fl_alloc(2 * pixels, sizeof(float), "a flow field", error)) ||
        !fl_lazy_state_init(&lazy->last, size.width, size.height, error))
        return NULL;
    return g_steal_pointer(&lazy);
}

static void level_clear(Level *level)
{
    fl_fluid_planes_clear(&level->planes);
    fl_fluid_picture_clear(&level->picture);
    fl_fluid_segments_clear(&level->segments);
    fl_nnf_clear(&level->nnf);
    fl_nnf_clear(&level->warm);
    free(level->rgba);
    *level = (Level){0};
}

static void clear_levels(FlLazy *lazy)
{
    for (int l = 0; l < FL_MAX_LEVELS; l++)
        level_clear(&lazy->level[l]);
}

void fl_lazy_free(FlLazy *lazy)
{
    if (!lazy)
        return;
    clear_levels(lazy);
    fl_fluid_exemplar_clear(&lazy->source);
    fl_lazy_state_clear(&lazy->last);
    free(lazy->motion);
    g_free(lazy);
}

/* ---- the target ------------------------------------------------------------------------------ */

/* The frame of the exemplar that goes with a frame: it begins again after its last. */
static int frame_in_step(const FlLazy *lazy, int frame)
{
    const FlExemplarLevel *full = &lazy->exemplar->level[0];
    const int n = full->window;
    return full->first + (frame % n + n) % n;
}

static bool pack_source(FlLazy *lazy, GError **error)
{
    const int now = lazy->last.frame - 1; // counted from 0; the frame in hand is counted already
    return fl_fluid_exemplar_pack(&lazy->source, lazy->exemplar, frame_in_step(lazy, now),
                                  frame_in_step(lazy, now - 1), lazy->n_levels, lazy->sigma_px,
                                  &lazy->weights, error);
}

/* Blurred alpha, and the past if there is one. */
static bool fill_planes(FlLazy *lazy, const FlGuides *guides, GError **error)
{
    FlFluidPlanes *planes = &lazy->level[0].planes;
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    if (!fl_fluid_planes_init(planes, lazy->width, lazy->height, error))
        return false;
    for (size_t p = 0; p < pixels; p++)
        planes->plane[FL_FLUID_PLANE_EDGE][p] = (float)guides->mask[p] / 255;
    if (!fl_fluid_planes_blur(planes, lazy->sigma_px, error))
        return false;
    return !lazy->last.valid ||
           (fl_fluid_motion(guides, (int)(BAND * lazy->sigma_px) + 3, lazy->motion, error) &&
            fl_fluid_warp(&lazy->last.past, guides, lazy->motion, lazy->last.frame, &lazy->kernels,
                          planes, error));
}

static bool level_init(FlLazy *lazy, int l, GError **error)
{
    Level *level = &lazy->level[l];
    FlFluidPlanes *planes = &level->planes;
    if (l > 0) {
        const FlFluidPlanes *fine = &lazy->level[l - 1].planes;
        if (!fl_fluid_planes_init(planes, (fine->width + 1) / 2, (fine->height + 1) / 2, error))
            return false;
        fl_fluid_planes_halve(fine, planes);
    }
    const size_t pixels = (size_t)planes->width * (size_t)planes->height;
    return (level->rgba = fl_alloc(4 * pixels, sizeof(float), "a picture", error)) &&
           fl_fluid_picture_init(&level->picture, planes->width, planes->height, error) &&
           fl_nnf_init(&level->nnf, planes->width, planes->height, error) &&
           fl_fluid_segments_init(&level->segments, planes, error) &&
           (lazy->source.level[l].segments.n[1] > 0 ||
            fl_fluid_segments_merge(&level->segments, error));
}

/* The last field in the size of every level. */
static bool carry_field(FlLazy *lazy, GError **error)
{
    for (int l = 0; l < lazy->n_levels; l++) {
        Level *level = &lazy->level[l];
        if (!fl_nnf_init(&level->warm, level->nnf.width, level->nnf.height, error))
            return false;
        if (l == 0)
            fl_fluid_carry(&lazy->last.past.nnf, lazy->motion, &level->warm);
        else
            fl_nnf_downscale(&lazy->level[0].warm, l, &lazy->source.level[l].voted, &level->warm);
    }
    return true;
}

/* ---- a level --------------------------------------------------------------------------------- */

static FlMatch random_match(const FlFluidLevel *source, int segment, uint64_t key)
{
    const FlFluidSegments *s = &source->segments;
    FlRng rng = {key};
    const uint32_t p = s->place[segment][fl_rng_below(&rng, (uint32_t)s->n[segment])];
    const uint32_t width = (uint32_t)source->picture.width;
    return (FlMatch){.x_16 = (uint16_t)(16 * (p % width)), .y_16 = (uint16_t)(16 * (p / width))};
}

/* A match for every pixel of the segments and none elsewhere: the carried one, else as it is, else
 * a random one. */
static void complete(const FlLazy *lazy, int l, uint64_t key)
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
            if (level->warm.match && level->warm.match[p].frame != FL_NO_MATCH)
                *m = level->warm.match[p];
            if (m->frame == FL_NO_MATCH)
                *m = random_match(&lazy->source.level[l], s, fl_key(key, p));
        }
}

/* Nothing but paper where no patch votes. */
static void vote(const FlLazy *lazy, int l)
{
    const Level *level = &lazy->level[l];
    const size_t pixels = (size_t)level->nnf.width * (size_t)level->nnf.height;
    for (size_t p = 0; p < pixels; p++) {
        for (size_t c = 0; c < 3; c++)
            level->rgba[4 * p + c] =
                lazy->exemplar->cut_out ? 0 : lazy->exemplar->paper[c] / 255.0f;
        level->rgba[4 * p + 3] = 0;
    }
    fl_vote(&level->nnf, &lazy->source.level[l].voted, &lazy->kernels, lazy->params->vote_sharpness,
            4, level->rgba, NULL);
}

/*
 * Every level begins with X^ where there was fluid; the coarser level counts for what is new. From
 * the coarser field alone, fine texture stood still: a motion of 2 px is less than a pixel of a
 * coarse level, whose patches stay, and X counts more than X^ by 1 / lambda. Measured: the texture
 * of a translation moved by 0 of 2 px with lambda .5 and four levels.
 */
static void start_from_past(const Level *level)
{
    const size_t pixels = (size_t)level->nnf.width * (size_t)level->nnf.height;
    for (size_t p = 0; p < pixels; p++)
        for (size_t c = 0; c < 4; c++) {
            const float w = level->planes.plane[FL_FLUID_PLANE_WEIGHT][p];
            const float past = level->planes.plane[FL_FLUID_PLANE_PAST + (int)c][p];
            level->rgba[4 * p + c] += w * (past - level->rgba[4 * p + c]);
        }
}

static void pack_target(const FlLazy *lazy, Level *level)
{
    const size_t pixels = (size_t)level->nnf.width * (size_t)level->nnf.height;
    for (size_t c = 0; c < 4; c++)
        for (size_t p = 0; p < pixels; p++)
            level->planes.plane[c][p] = level->rgba[4 * p + c];
    fl_fluid_picture_pack(&level->planes, &lazy->weights, true, &level->picture);
}

/* Border, then interior; on a level without separate ones the first is all. */
static bool retrieve(FlLazy *lazy, int l, uint64_t key, FlLevelStats *stats, GError **error)
{
    Level *level = &lazy->level[l];
    const FlFluidLevel *source = &lazy->source.level[l];
    const FlParams *params = lazy->params;
    stats->energy = 0;
    for (int s = 0; s < 2; s++) {
        const FlRetrieval in = {.source = source->picture,
                                .target = level->picture,
                                .sources = source->segments.place[s],
                                .targets = level->segments.place[s],
                                .n_sources = source->segments.n[s],
                                .n_targets = level->segments.n[s],
                                .turns = params->rotate,
                                .uniform = params->w_uni <= 0       ? FL_UNIFORM_OFF
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

static bool run_level(FlLazy *lazy, int l, FlLevelStats *stats, GError **error)
{
    Level *level = &lazy->level[l];
    const FlParams *params = lazy->params;
    const uint64_t key = fl_key(fl_key(lazy->key, (uint64_t)lazy->last.frame), (uint64_t)l);
    const int from_coarsest = lazy->n_levels - 1 - l;
    *stats = (FlLevelStats){.width = level->nnf.width, .height = level->nnf.height};
    stats->pixels = (int)(level->segments.n[0] + level->segments.n[1]);
    stats->rounds =
        l == 0 ? params->finest_rounds : fl_list_at(&params->opt_iterations, from_coarsest);
    if (from_coarsest > 0)
        fl_nnf_upscale(&lazy->level[l + 1].nnf, &lazy->source.level[l].voted, &lazy->kernels,
                       &level->nnf);
    complete(lazy, l, fl_key(key, 1));
    vote(lazy, l);
    if (lazy->last.valid)
        start_from_past(level);
    for (int round = 0; round < stats->rounds; round++) {
        pack_target(lazy, level);
        if (!retrieve(lazy, l, fl_key(key, 2 + (uint64_t)round), stats, error))
            return false;
        vote(lazy, l);
    }
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
        stats->level[l].seconds = (double)(g_get_monotonic_time() - start) * 1e-6;
        stats->seconds_search += stats->level[l].seconds;
    }
    return true;
}

static bool prepare(FlLazy *lazy, const FlGuides *guides, GError **error)
{
    if (!pack_source(lazy, error) || !fill_planes(lazy, guides, error))
        return false;
    for (int l = 0; l < lazy->n_levels; l++)
        if (!level_init(lazy, l, error))
            return false;
    return !lazy->last.valid || carry_field(lazy, error);
}

/* What the next frame is warped from. */
static void remember(FlLazy *lazy, const FlGuides *guides)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    FlFluidPast *past = &lazy->last.past;
    for (size_t k = 0; k < 4 * pixels; k++)
        past->rgba[k] = (uint16_t)(lazy->level[0].rgba[k] * FL_FLUID_DEPTH + .5f);
    memcpy(past->mask, guides->mask, pixels);
    fl_rest_shape(guides, lazy->last.shape);
    memcpy(past->nnf.match, lazy->level[0].nnf.match, pixels * sizeof(FlMatch));
    for (size_t p = 0; p < pixels; p++)
        if (past->nnf.match[p].frame != FL_NO_MATCH)
            past->nnf.match[p].frame = (int16_t)lazy->source.frame;
    lazy->last.valid = true;
}

/* A colour as it is, where rgba has it times its alpha: where that is 0, the paper's. */
static uint8_t straight(const uint16_t *rgba, int c, uint8_t paper)
{
    const uint32_t alpha = rgba[3], value = MIN(rgba[c], alpha);
    return alpha > 0 ? (uint8_t)((value * 255 + alpha / 2) / alpha) : paper;
}

/* The last output, blurred along the motion where that is asked for. */
static bool write_output(const FlLazy *lazy, uint8_t *rgb, uint8_t *alpha, GError **error)
{
    const size_t pixels = (size_t)lazy->width * (size_t)lazy->height;
    const float shutter = lazy->params->motion_blur;
    g_autofree uint16_t *blurred = NULL;
    if (shutter > 0 && lazy->level[0].nnf.match) { // a first frame has no motion
        if (!(blurred = fl_motion_blur(lazy->last.past.rgba, lazy->motion, lazy->width,
                                       lazy->height, lazy->exemplar->cut_out, shutter, error)))
            return false;
    }
    const uint16_t *rgba = blurred ? blurred : lazy->last.past.rgba;
    for (size_t p = 0; p < pixels; p++) {
        for (size_t c = 0; c < 3; c++)
            rgb[3 * p + c] = lazy->exemplar->cut_out
                                 ? straight(rgba + 4 * p, (int)c, lazy->exemplar->paper[c])
                                 : (uint8_t)((rgba[4 * p + c] + 128) / 257);
        if (alpha)
            alpha[p] = (uint8_t)((rgba[4 * p + 3] + 128) / 257);
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
    lazy->last.valid = false;
}

static bool is_empty(const FlLazy *lazy, const FlGuides *guides)
{
    for (size_t p = 0; p < (size_t)lazy->width * (size_t)lazy->height; p++)
        if (guides->mask[p] >= FL_INSIDE)
            return false;
    return true;
}

/* A video goes on while the drawing holds; a still has nothing to show. */
static bool holds_still(const FlLazy *lazy, const FlGuides *guides)
{
    return lazy->params->rest && lazy->last.valid && lazy->exemplar->level[0].window == 1 &&
           fl_rests(guides, lazy->last.shape, lazy->params->flow_still);
}

static bool paint(FlLazy *lazy, const FlGuides *guides, uint8_t *rgb, uint8_t *alpha,
                  FlFrameStats *stats, GError **error)
{
    clear_levels(lazy);
    lazy->last.frame++;
    if (is_empty(lazy, guides)) {
        write_nothing(lazy, rgb, alpha);
        return true;
    }
    if (!holds_still(lazy, guides)) {
        const bool first = !lazy->last.valid;
        if (!prepare(lazy, guides, error) || !run_levels(lazy, stats, error))
            return false;
        if (first)
            memset(lazy->motion, 0, 2 * (size_t)lazy->width * (size_t)lazy->height * sizeof(float));
        remember(lazy, guides);
    }
    return write_output(lazy, rgb, alpha, error);
}

bool fl_lazy_frame(FlLazy *lazy, const FlGuides *guides, uint8_t *rgb, uint8_t *alpha,
                   FlFrameStats *stats, FlSynthView *view, GError **error)
{
    FlFrameStats no_stats = {0};
    FlFrameStats *const s = stats ? stats : &no_stats;
    *s = (FlFrameStats){0};
    const bool done = paint(lazy, guides, rgb, alpha, s, error);
    if (view)
        *view = (FlSynthView){{0, 0, lazy->width, lazy->height},
                              done && lazy->last.valid ? &lazy->last.past.nnf : NULL,
                              NULL,
                              NULL};
    else
        clear_levels(lazy);
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
