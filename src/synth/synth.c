#include "synth/synth.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "guides/half_guides.h"
#include "synth/carry.h"
#include "synth/energy.h"
#include "synth/patch_pairs.h"
#include "synth/rest.h"
#include "synth/shift.h"
#include "synth/synth_state.h"
#include "synth/vote.h"
#include <math.h>
#include <string.h>

#define NEAR_PX 8 // on the finest level; around a match that has settled, on coarser levels

struct FlSynth {
    const FlExemplar *exemplar;
    const FlEnlargement *enlargement; // by which pictures are made; NULL: in the size of the field
    const FlParams *params;
    FlCostScale scale;
    FlKernels kernels;
    int width, height, n_levels;
    float side; // the larger one of the whole frames, px
    uint64_t key;
    FlSynthState last; // after the last frame; its planes are here in a frame, and for a view
    GBytes *packed;    // it, with its planes; NULL since they have changed
    int boil;          // fl_boil_step() before the frame in hand
    bool moves;        // the drawing's motion is known in the frame in hand
    bool wants_energies;
    bool wants_view;                     // of the frame in hand
    double seconds_search, seconds_vote; // of the frame in hand
    FlTarget target; // of the frame in hand; kept until the next for FlSynthView
    FlNnf nnf[FL_MAX_LEVELS];
    FlRest rest;       // of the frame in hand: its parts at rest
    FlSynthState past; // in a frame with such parts: the planes of the last one
    FlSynthView view;  // of the last frame that was painted, where somebody wanted it
    FlNnf shown;       // its field in the size of the picture, where that is another
};

FlSynth *fl_synth_new(const FlExemplar *exemplar, const FlParams *params, FlSynthSize size,
                      uint64_t seed)
{
    FlSynth *synth = g_new0(FlSynth, 1);
    synth->exemplar = exemplar;
    synth->params = params;
    synth->width = synth->last.width = synth->last.painted_width = size.width;
    synth->height = synth->last.height = synth->last.painted_height = size.height;
    synth->side = (float)MAX(size.frame_width, size.frame_height);
    synth->n_levels = MIN(exemplar->n_levels, fl_levels_of(size.frame_width, size.frame_height));
    synth->key = fl_hash64(seed);
    fl_cost_scale_init(&synth->scale, params);
    fl_kernels_init(&synth->kernels, fl_cpu_flags());
    return synth;
}

void fl_synth_enlarge(FlSynth *synth, const FlEnlargement *enlargement, int width, int height)
{
    synth->enlargement = enlargement;
    synth->last.painted_width = width, synth->last.painted_height = height;
}

static void forget_packed(FlSynth *synth)
{
    g_clear_pointer(&synth->packed, g_bytes_unref);
}

static void clear_frame(FlSynth *synth)
{
    for (int l = 0; l < synth->n_levels; l++)
        fl_nnf_clear(&synth->nnf[l]);
    fl_target_clear(&synth->target);
    fl_rest_clear(&synth->rest);
    fl_synth_state_clear(&synth->past);
    fl_nnf_clear(&synth->shown);
    synth->view = (FlSynthView){0};
}

void fl_synth_free(FlSynth *synth)
{
    if (!synth)
        return;
    clear_frame(synth);
    forget_packed(synth);
    fl_synth_state_clear(&synth->last);
    g_free(synth);
}

void fl_synth_measure(FlSynth *synth, bool energies)
{
    synth->wants_energies = energies;
}

/* The mask's bounding box, enlarged by the coarsest patches, on the coarsest grid. */
static bool working_rect(const FlSynth *synth, const FlGuides *guides, FlRect *rect)
{
    int x0 = synth->width, y0 = synth->height, x1 = -1, y1 = -1;
    for (int y = 0; y < synth->height; y++)
        for (int x = 0; x < synth->width; x++)
            if (guides->mask[(size_t)y * synth->width + x] >= FL_INSIDE) {
                x0 = MIN(x0, x), x1 = MAX(x1, x);
                y0 = MIN(y0, y), y1 = MAX(y1, y);
            }
    const int grid = 1 << (synth->n_levels - 1);
    const FlRect page = {0, 0, synth->width, synth->height};
    const FlRect box = fl_rect_between(x0, y0, x1 + 1, y1 + 1);
    *rect = fl_rect_on_grid(fl_rect_grown(box, FL_PATCH_RADIUS * grid, page), grid);
    return box.width > 0;
}

/* The previous field in the new rectangle, carried along the drawing's motion and shifted in the
 * exemplar's time. */
static bool shifted_previous(const FlSynth *synth, const FlGuides *guides, FlRect rect, FlNnf *out,
                             GError **error)
{
    const size_t pixels = (size_t)rect.width * rect.height;
    g_autofree float *speed = fl_alloc(pixels, sizeof(float), "a field", error);
    g_autofree uint8_t *angle = fl_alloc(pixels, 1, "a field", error);
    if (!speed || !angle || !fl_nnf_init(out, rect.width, rect.height, error))
        return false;
    const FlCarry carry = {guides, synth->params->carry, synth->params->rotate, synth->last.frame};
    fl_nnf_carry(&synth->last.nnf, synth->last.rect, &carry, rect, &synth->exemplar->level[0], out,
                 speed);
    for (int y = 0; y < rect.height; y++)
        memcpy(angle + (size_t)y * rect.width,
               guides->angle + (size_t)(rect.y + y) * synth->width + rect.x, (size_t)rect.width);
    const FlTargetMotion motion = {speed, angle, synth->params->flow_still, synth->boil};
    fl_nnf_shift(out, synth->exemplar, &motion);
    return true;
}

/* The finest level that is searched. Where it is not the finest of all, as in drafts, that one is
 * the coarser level's field, enlarged. */
static int finest_searched(const FlSynth *synth)
{
    return synth->params->finest_rounds == 0 && !synth->enlargement && synth->n_levels > 1 ? 1 : 0;
}

/* The previous field in a level's size: `shifted`, or `down`, which is made. *previous stays NULL
 * where there is none. */
static bool previous_of_level(const FlSynth *synth, const FlNnf *shifted, int l, FlNnf *down,
                              const FlNnf **previous, GError **error)
{
    const FlTargetLevel *target = &synth->target.level[l];
    *previous = shifted;
    if (!shifted || l == 0)
        return true;
    if (!fl_nnf_init(down, target->width, target->height, error))
        return false;
    fl_nnf_downscale(shifted, l, &synth->exemplar->level[l], down);
    *previous = down;
    return true;
}

/* Half a carry trusts the middle of large shapes by an eighth, so that paint is renewed there;
 * where no motion is known nothing is carried. */
static FlTemporalTrust trust_of(const FlSynth *synth)
{
    const FlParams *params = synth->params;
    const float lower_px = params->temp_lower * synth->side;
    const float upper_px = MAX(params->temp_upper * synth->side, lower_px + 1e-3f);
    const float carry = synth->moves ? params->carry : 0;
    return (FlTemporalTrust){lower_px, upper_px, carry * carry * carry};
}

/* T_temp and m(q) of a level from the last field in that level's size. */
static bool make_temporal_level(FlSynth *synth, const FlNnf *shifted, int l, GError **error)
{
    FlTargetLevel *target = &synth->target.level[l];
    const size_t pixels = (size_t)target->width * target->height;
    g_autofree uint8_t *voted = fl_alloc(pixels, 1, "a temporal guide", error);
    if (!voted)
        return false;
    fl_vote(shifted, &synth->exemplar->level[l], &synth->kernels, synth->params->vote_sharpness, 3,
            target->temporal, voted);
    const FlTemporalTrust trust = trust_of(synth);
#pragma omp parallel for schedule(static)
    for (size_t p = 0; p < pixels; p++)
        if (voted[p] && shifted->match[p].frame != FL_NO_MATCH)
            target->temporal_weight[p] = fl_temporal_weight(
                synth->exemplar,
                fl_match_enlarged(shifted->match[p], l, &synth->exemplar->level[0]),
                target->distance[p], &trust);
    return true;
}

/* T_temp and m(q) on every level that is searched. */
static bool make_temporal(FlSynth *synth, const FlNnf *shifted, GError **error)
{
    const int l = finest_searched(synth);
    g_auto(FlNnf) down = {0};
    const FlNnf *previous;
    if (!previous_of_level(synth, shifted, l, &down, &previous, error) ||
        !make_temporal_level(synth, previous, l, error))
        return false;
    fl_target_temporal_pyramid(&synth->target, l);
    return true;
}

static double mean_energy(const FlSearch *search)
{
    return fl_mean_cost(search) / search->scale->unit;
}

/* Seconds since a monotonic time, which moves on to now. */
static double lap(gint64 *since)
{
    const gint64 now = g_get_monotonic_time(), before = *since;
    *since = now;
    return (double)(now - before) * 1e-6;
}

static void vote(FlSynth *synth, const FlSearch *search, FlTargetLevel *target)
{
    gint64 time = g_get_monotonic_time();
    fl_vote(search->nnf, search->level, search->kernels, search->params->vote_sharpness, 3,
            target->colour, NULL);
    synth->seconds_vote += lap(&time);
}

/* The search reads the blend alone: colours and T_temp are not needed after the last one. */
static void drop_blended(const FlSynth *synth, FlTargetLevel *target)
{
    if (synth->wants_energies || synth->wants_view)
        return;
    g_clear_pointer(&target->temporal, free);
    g_clear_pointer(&target->colour, free);
}

/* last: the level's last blend. */
static void vote_and_blend(FlSynth *synth, const FlSearch *search, FlTargetLevel *target, bool last)
{
    vote(synth, search, target);
    fl_target_blend(target, search->params, search->scale, search->params->w_texture);
    if (last)
        drop_blended(synth, target);
}

/* The costs of the field must be those of the target as it is, unless they are `stale`. */
static FlSearchCounts timed_search(FlSynth *synth, FlSearch *search, int sweeps, bool stale)
{
    gint64 time = g_get_monotonic_time();
    fl_occurrence_count(search->map, search->nnf, search->target);
    if (stale)
        fl_search_costs(search, NULL);
    const FlSearchCounts counts = fl_search_run(search, sweeps);
    synth->seconds_search += lap(&time);
    return counts;
}

/* The field to start a level with: from the coarser level, which then may go, from the previous
 * frame, or random. */
static void initialise(FlSynth *synth, FlSearch *search, FlTargetLevel *target, int l, int rounds,
                       const FlNnf *previous)
{
    const FlParams *params = synth->params;
    const bool coarsest = l == synth->n_levels - 1;
    const uint64_t key = fl_key(search->key, 1);
    if (!coarsest) {
        fl_nnf_upscale(&synth->nnf[l + 1], search->level, search->kernels, search->nnf);
        fl_nnf_clear(&synth->nnf[l + 1]);
    } else if (previous && previous->match)
        memcpy(search->nnf->match, previous->match,
               (size_t)previous->width * previous->height * sizeof *previous->match);
    fl_nnf_repair(search->nnf, search->level, target, params->rotate, key);
    if (coarsest && !previous) { // guides alone decide the first guess [P21 §4.2]
        fl_target_blend(target, params, &synth->scale, 0);
        timed_search(synth, search, fl_list_at(&params->patchmatch_iterations, 0), true);
    }
    if (l < finest_searched(synth))
        return;
    vote_and_blend(synth, search, target, rounds == 1);
    fl_search_costs(search, coarsest ? NULL : previous);
}

/* Paper where no patch votes. The plane takes memory from here on: of the finest level, which is
 * the largest, once the coarser levels have gone. */
static void clear_colours(const FlSynth *synth, FlTargetLevel *level)
{
    for (size_t p = 0; p < 3 * (size_t)level->width * level->height; p++)
        level->colour[p] = synth->exemplar->paper[p % 3] / 255.0f;
}

/* Votes for the picture, or for energies. */
static bool last_vote(FlSynth *synth, const FlSearch *search, FlTargetLevel *target, GError **error)
{
    if (!target->colour) {
        const size_t values = 3 * (size_t)target->width * target->height;
        target->colour = fl_alloc_unset(values, sizeof *target->colour, "a target", error);
        if (!target->colour)
            return false;
        clear_colours(synth, target);
    }
    vote(synth, search, target);
    return true;
}

/* Search and vote in turn [F21 alg. 2]; the field comes with its costs. The next level votes anew,
 * so that the last vote is for the finest level's picture, or for energies. */
static bool optimise(FlSynth *synth, FlSearch *search, FlTargetLevel *target, int rounds,
                     int sweeps, FlLevelStats *stats, GError **error)
{
    const bool shown = target == &synth->target.level[0] && !synth->enlargement;
    const bool last_counts = shown || synth->wants_energies;
    const uint64_t key = search->key;
    for (int round = 0; round < rounds; round++) {
        const bool last = round + 1 == rounds;
        search->key = fl_key(key, 2 + (uint64_t)round);
        const FlSearchCounts counts = timed_search(synth, search, sweeps, round > 0);
        stats->counts.drawn += counts.drawn;
        stats->counts.tried += counts.tried;
        stats->counts.accepted += counts.accepted;
        if (!last)
            vote_and_blend(synth, search, target, round + 2 == rounds);
        else if (last_counts && !last_vote(synth, search, target, error))
            return false;
    }
    search->key = key;
    return true;
}

/* The energy of the field that the level ends with, and its terms. */
static void end_statistics(FlSearch *search, FlTargetLevel *target, FlLevelStats *stats)
{
    FlEnergy energy;
    fl_target_blend(target, search->params, search->scale, search->params->w_texture);
    fl_occurrence_count(search->map, search->nnf, target);
    fl_energy_of(search, target, search->cost, &energy);
    fl_search_costs(search, NULL);
    stats->energy = mean_energy(search);
    stats->texture = energy.texture, stats->temporal = energy.temporal;
    stats->bound = energy.bound, stats->ext = energy.ext, stats->direction = energy.direction;
    stats->uniformity = energy.uniformity, stats->coherence = energy.coherence;
}

/* Matches that are good as they are cost little time: random tries find next to nothing for them,
 * in a frame that continues another, where they were good before, least of all. */
static void settle(FlSearch *search, int level, bool continues)
{
    search->settled = (uint32_t)MIN(search->params->settled * fl_mean_cost(search), UINT32_MAX);
    search->near_px = !continues ? INT_MAX : level > 0 ? NEAR_PX << level : 0;
}

static bool run_level(FlSynth *synth, int l, const FlNnf *shifted, FlLevelStats *stats,
                      GError **error)
{
    const FlParams *params = synth->params;
    FlTargetLevel *target = &synth->target.level[l];
    const size_t pixels = (size_t)target->width * target->height;
    g_autofree uint32_t *cost = fl_alloc_scratch(pixels, sizeof *cost, "a field", error);
    g_autofree uint8_t *changed = fl_alloc_scratch(pixels, 1, "a field", error);
    g_auto(FlOccurrence) map = {0};
    g_auto(FlNnf) down = {0};
    const FlNnf *previous;
    if (!cost || !changed || !previous_of_level(synth, shifted, l, &down, &previous, error) ||
        !fl_nnf_init(&synth->nnf[l], target->width, target->height, error) ||
        !fl_occurrence_init(&map, &synth->exemplar->level[l], target, params, &synth->scale, error))
        return false;
    FlSearch search = {.level = &synth->exemplar->level[l],
                       .target = target,
                       .params = params,
                       .scale = &synth->scale,
                       .w_coh = (double)params->w_coh * (1 - (double)synth->exemplar->smoothness),
                       .kernels = &synth->kernels,
                       .nnf = &synth->nnf[l],
                       .cost = cost,
                       .carried = synth->moves ? previous : NULL,
                       .map = &map,
                       .changed = params->settled > 0 ? changed : NULL,
                       .key = fl_key(fl_key(synth->key, (uint64_t)synth->last.frame), (uint64_t)l)};
    const int from_coarsest = synth->n_levels - 1 - l;
    const bool finest = l == 0 && !synth->enlargement;
    const int rounds =
        finest    ? params->finest_rounds
        : shifted ? fl_list_at(&params->next_iterations, from_coarsest)
                  : fl_list_at(&params->opt_iterations, from_coarsest) * params->first_rounds;
    clear_colours(synth, target);
    initialise(synth, &search, target, l, rounds, previous);
    *stats = (FlLevelStats){.width = target->width, .height = target->height, .rounds = rounds};
    stats->pixels = target->n_inside[FL_SEGMENT_BORDER] + target->n_inside[FL_SEGMENT_INTERIOR];
    stats->energy_start = synth->wants_energies ? mean_energy(&search) : 0;
    settle(&search, l, shifted);
    const int sweeps =
        finest ? params->finest_sweeps : fl_list_at(&params->patchmatch_iterations, from_coarsest);
    if (!optimise(synth, &search, target, rounds, sweeps, stats, error))
        return false;
    if (rounds == 0 && finest) // the field has not been voted yet
        vote(synth, &search, target);
    if (synth->wants_energies)
        end_statistics(&search, target, stats);
    return true;
}

/* The picture in twice the size of the field. */
static bool enlarge(const FlSynth *synth, uint8_t *rgb, GError **error)
{
    const FlEnlarged enlarged = {&synth->kernels, synth->params->vote_sharpness,
                                 synth->last.painted_width, synth->last.painted_height, rgb};
    return fl_enlarge(synth->enlargement, &synth->nnf[0], synth->target.rect, &enlarged, error);
}

static void write_rgb(const FlSynth *synth, uint8_t *rgb)
{
    const FlTargetLevel *full = &synth->target.level[0];
    const FlRect rect = synth->target.rect;
    for (int y = 0; y < rect.height; y++)
        for (int x = 0; x < 3 * rect.width; x++)
            rgb[3 * ((size_t)(rect.y + y) * synth->width + rect.x) + x] =
                fl_vote_byte(full->colour[3 * (size_t)y * rect.width + x]);
}

static void fill_paper(const FlSynth *synth, uint8_t *rgb)
{
    for (size_t p = 0; p < fl_synth_state_painted(&synth->last); p += 3)
        memcpy(rgb + p, synth->exemplar->paper, 3);
}

/* The target, and what the next frame needs of the guides, which then may go. */
static bool take_guides(FlSynth *synth, FlGuides *guides, FlRect rect, GError **error)
{
    const size_t pixels = (size_t)synth->width * synth->height;
    if (!(synth->last.mask = fl_alloc(pixels, 1, "a mask", error)))
        return false;
    fl_rest_shape(guides, synth->last.mask);
    if (guides->disposable)
        fl_guides_drop_motion(guides);
    if (guides->disposable && fl_knows_depth(synth->params))
        g_clear_pointer(&guides->distance, g_free);
    if (!fl_target_init(&synth->target, guides, synth->params, rect, synth->n_levels,
                        synth->exemplar, error))
        return false;
    if (guides->disposable)
        fl_guides_clear(guides);
    return true;
}

/* Parts at rest need the planes of the last frame until they have theirs. */
static void forget_last(FlSynth *synth)
{
    if (synth->rest.keeps)
        synth->past = synth->last;
    else
        fl_synth_state_clear(&synth->last);
    synth->last.nnf = (FlNnf){0};
    synth->last.mask = synth->last.rgb = NULL;
}

/* The last frame is large, and all that is needed of it is shifted: so that comes first. */
static bool prepare(FlSynth *synth, FlGuides *guides, FlRect rect, FlNnf *shifted,
                    FlFrameStats *stats, GError **error)
{
    gint64 time = g_get_monotonic_time();
    const bool continues = synth->last.valid;
    if (continues && !shifted_previous(synth, guides, rect, shifted, error))
        return false;
    forget_last(synth);
    stats->seconds_temporal = lap(&time);
    if (!take_guides(synth, guides, rect, error))
        return false;
    stats->seconds_target = lap(&time);
    if (continues && !make_temporal(synth, shifted, error))
        return false;
    fl_target_drop_distances(&synth->target);
    stats->seconds_temporal += lap(&time);
    return true;
}

/* The finest field, which is handed over, and where it lies. */
static void remember(FlSynth *synth)
{
    synth->last.valid = true;
    synth->last.rect = synth->target.rect;
    synth->last.nnf = synth->nnf[0];
    synth->nnf[0] = (FlNnf){0};
}

/* The picture as well, for as long as the planes of the frame are kept. */
static bool remember_picture(FlSynth *synth, const uint8_t *rgb, GError **error)
{
    if (!fl_synth_state_room(&synth->last, error))
        return false;
    memcpy(synth->last.rgb, rgb, fl_synth_state_painted(&synth->last));
    return true;
}

/* Whether a region at rest has its picture in the frame-th frame as well. */
static bool may_rest(const FlSynth *synth, int frame)
{
    const FlParams *params = synth->params;
    return params->rest && synth->last.valid &&
           fl_boil_step(params->boil, frame, synth->exemplar->level[0].window) == 0;
}

bool fl_synth_rest(FlSynth *synth)
{
    if (!may_rest(synth, synth->last.frame + 1))
        return false;
    synth->last.frame++;
    return true;
}

/* The planes of the last frame: regions wait for their next one with packed planes. */
static bool unpack_last(FlSynth *synth, GError **error)
{
    const int frame = synth->last.frame; // it may have rested since it was packed
    if (!synth->last.valid || synth->last.nnf.match)
        return true;
    const bool done =
        fl_synth_state_room(&synth->last, error) &&
        fl_synth_state_unpack(&synth->last, synth->packed, &synth->exemplar->level[0], error);
    synth->last.frame = frame;
    return done;
}

/* Whose picture is `rgb`. */
static bool pack_last(FlSynth *synth, uint8_t *rgb, GError **error)
{
    FlSynthState last = synth->last;
    last.rgb = rgb;
    if (!synth->packed)
        synth->packed = fl_synth_state_pack(&last, error);
    fl_synth_state_clear(&synth->last);
    return synth->packed != NULL;
}

static bool run_levels(FlSynth *synth, const FlNnf *shifted, FlFrameStats *stats, GError **error)
{
    synth->seconds_search = synth->seconds_vote = 0;
    stats->n_levels = synth->n_levels;
    for (int l = synth->n_levels - 1; l >= 0; l--) {
        gint64 time = g_get_monotonic_time();
        if (!run_level(synth, l, synth->last.valid ? shifted : NULL, &stats->level[l], error))
            return false;
        if (l > 0) // the next one needs its field only
            fl_target_level_clear(&synth->target.level[l]);
        stats->level[l].seconds = lap(&time);
    }
    stats->seconds_search = synth->seconds_search, stats->seconds_vote = synth->seconds_vote;
    return true;
}

/* That of the picture which is kept; only its field is, if nobody wanted a view of it. */
static FlSynthView view_at_rest(const FlSynth *synth)
{
    const FlSynthState *last = &synth->last;
    return synth->view.nnf ? synth->view : (FlSynthView){last->rect, &last->nnf, NULL, NULL};
}

/* Paints what the mask has in a rectangle. */
static bool paint_rect(FlSynth *synth, FlGuides *guides, FlRect rect, uint8_t *rgb,
                       FlFrameStats *stats, GError **error)
{
    g_auto(FlNnf) shifted = {0};
    if (!prepare(synth, guides, rect, &shifted, stats, error) ||
        !run_levels(synth, &shifted, stats, error))
        return false;
    fill_paper(synth, rgb); // not before: until it is written to, it takes no memory
    if (!synth->enlargement)
        write_rgb(synth, rgb);
    else if (!enlarge(synth, rgb, error))
        return false;
    const FlTargetLevel *full = &synth->target.level[0];
    const bool has_temporal =
        synth->last.valid && finest_searched(synth) == 0 && !synth->enlargement;
    remember(synth);
    synth->view = (FlSynthView){rect, &synth->last.nnf, has_temporal ? full->temporal : NULL,
                                has_temporal ? full->temporal_weight : NULL};
    return true;
}

/* Looks which parts rest, and hides them, so that `rect` is that of the others. mask: that of the
 * guides until then; NULL: all is painted. */
static bool part(FlSynth *synth, FlGuides *guides, FlRect *rect, uint8_t **mask, GError **error)
{
    if (!may_rest(synth, synth->last.frame))
        return true;
    if (!fl_rest_init(&synth->rest, guides, synth->last.mask, synth->params->flow_still, error))
        return false;
    if (!synth->rest.keeps)
        return true;
    const size_t pixels = (size_t)synth->width * synth->height;
    if (!(*mask = fl_alloc(pixels, 1, "a mask", error)))
        return false;
    memcpy(*mask, guides->mask, pixels);
    fl_rest_hide(&synth->rest, guides->mask);
    FlRect moving;
    if (working_rect(synth, guides, &moving)) {
        *rect = moving;
        return true;
    }
    memcpy(guides->mask, *mask, pixels); // a part has gone, and no other moves
    g_clear_pointer(mask, free);
    fl_rest_clear(&synth->rest);
    return true;
}

/* For a view: the target of all parts. Those at rest have no T_temp. */
static bool show_all(FlSynth *synth, const FlGuides *guides, FlRect rect, GError **error)
{
    g_auto(FlTarget) moving = synth->target;
    synth->target = (FlTarget){0};
    if (!fl_target_init(&synth->target, guides, synth->params, rect, synth->n_levels,
                        synth->exemplar, error))
        return false;
    const FlTargetLevel *from = &moving.level[0], *to = &synth->target.level[0];
    fl_rect_copy(from->temporal, moving.rect, to->temporal, rect, 3 * sizeof *to->temporal);
    fl_rect_copy(from->temporal_weight, moving.rect, to->temporal_weight, rect,
                 sizeof *to->temporal_weight);
    synth->view.rect = rect;
    if (synth->view.temporal)
        synth->view.temporal = to->temporal, synth->view.temporal_weight = to->temporal_weight;
    return true;
}

/* Paints the frame; shows: somebody wants its view. */
static bool paint(FlSynth *synth, FlGuides *guides, uint8_t *rgb, FlFrameStats *stats, bool shows,
                  GError **error)
{
    FlRect all, rect;
    g_autofree uint8_t *mask = NULL;
    synth->last.frame++;
    synth->boil =
        fl_boil_step(synth->params->boil, synth->last.frame, synth->exemplar->level[0].window);
    if (!unpack_last(synth, error))
        return false;
    if (may_rest(synth, synth->last.frame) &&
        fl_rests(guides, synth->last.mask, synth->params->flow_still)) {
        memcpy(rgb, synth->last.rgb, fl_synth_state_painted(&synth->last));
        synth->view = view_at_rest(synth);
        return true;
    }
    clear_frame(synth);
    forget_packed(synth);
    synth->moves = guides->has_motion;
    if (!working_rect(synth, guides, &all)) {
        fill_paper(synth, rgb);
        synth->last.valid = false;
        return true;
    }
    rect = all;
    const bool disposable = guides->disposable;
    guides->disposable &= !shows;
    synth->wants_view = shows;
    if (!part(synth, guides, &rect, &mask, error) ||
        !paint_rect(synth, guides, rect, rgb, stats, error))
        return false;
    guides->disposable = disposable;
    if (mask && guides->mask)
        memcpy(guides->mask, mask, (size_t)synth->width * synth->height);
    return !mask || (fl_rest_keep(&synth->rest, &synth->past, all, &synth->last, rgb, error) &&
                     (!shows || show_all(synth, guides, all, error)));
}

/* The view in the size of the picture. */
static bool double_view(FlSynth *synth, GError **error)
{
    FlSynthView *view = &synth->view;
    const FlRect page = {0, 0, synth->last.painted_width, synth->last.painted_height};
    if (!synth->enlargement || !view->nnf || synth->shown.match)
        return true;
    view->rect = fl_rect_doubled(view->rect, page);
    if (!fl_nnf_init(&synth->shown, view->rect.width, view->rect.height, error))
        return false;
    fl_plane_double(view->nnf->match, view->rect.width, view->rect.height, sizeof(FlMatch),
                    synth->shown.match);
    view->nnf = &synth->shown;
    return true;
}

bool fl_synth_frame(FlSynth *synth, FlGuides *guides, uint8_t *rgb, FlFrameStats *stats,
                    FlSynthView *view, GError **error)
{
    FlFrameStats no_stats;
    FlFrameStats *const s = stats ? stats : &no_stats;
    *s = (FlFrameStats){0};
    const bool done =
        paint(synth, guides, rgb, s, view, error) && (!view || double_view(synth, error));
    if (view) {
        *view = synth->view;
        return done && (!synth->last.valid || remember_picture(synth, rgb, error));
    }
    clear_frame(synth);
    return done && pack_last(synth, rgb, error);
}

bool fl_synth_guide_pairs(const FlSynth *synth, FlGuidePairs *pairs, GError **error)
{
    return fl_patch_pairs(synth->exemplar, synth->params, &synth->target, &synth->last.nnf,
                          synth->width, synth->height, pairs, error);
}

GBytes *fl_synth_save(FlSynth *synth, GError **error)
{
    GBytes *packed = synth->packed ? fl_synth_state_later(synth->packed, synth->last.frame)
                                   : fl_synth_state_pack(&synth->last, error);
    if (!packed)
        return NULL;
    forget_packed(synth);
    synth->packed = packed;
    return g_bytes_ref(packed);
}

bool fl_synth_load(FlSynth *synth, GBytes *state, GError **error)
{
    forget_packed(synth);
    fl_synth_state_clear(&synth->last);
    if (!fl_synth_state_room(&synth->last, error))
        return false;
    const bool done = fl_synth_state_unpack(&synth->last, state, &synth->exemplar->level[0], error);
    fl_synth_state_clear(&synth->last);
    if (done)
        synth->packed = g_bytes_ref(state);
    else
        synth->last.valid = false;
    return done;
}
