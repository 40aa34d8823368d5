#include "synth/synth_levels.h"

#include "base/alloc.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "synth/carry.h"
#include "synth/shift.h"
#include "synth/synth_data.h"
#include "synth/vote.h"
#include <string.h>

#define NEAR_PX 8 // on the finest level; around a match that has settled, on coarser levels
#define FINEST_RANDOM_SWEEPS 3 // on the finest level; later ones make no visible difference

int fl_synth_finest_searched(const FlSynth *synth)
{
    return synth->params->finest_rounds == 0 && synth->n_levels > 1 ? 1 : 0;
}

float fl_synth_sharpness(const FlSynth *synth)
{
    return 1 + (synth->params->vote_sharpness - 1) * (1 - synth->exemplar->melt);
}

/* The previous field in a level's size: `shifted`, or `down`, which is made. *previous stays NULL
 * without a previous field. */
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

/* Half a carry trusts the middle of large shapes by an eighth, which renews their paint; matches
 * are not carried where the motion is unknown. */
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
    fl_vote(shifted, NULL, &synth->exemplar->level[l], &synth->kernels, fl_synth_sharpness(synth),
            3, target->temporal, voted);
    const FlTemporalTrust trust = trust_of(synth);
#pragma omp parallel for schedule(dynamic, 4096)
    for (size_t p = 0; p < pixels; p++)
        if (voted[p] && shifted->match[p].frame != FL_NO_MATCH)
            target->temporal_weight[p] = fl_temporal_weight(
                synth->exemplar,
                fl_match_enlarged(shifted->match[p], l, &synth->exemplar->level[0]),
                target->distance[p], &trust);
    return true;
}

/* True if carried paint that fits is kept; false if every match shall be searched. */
static bool keeps(const FlParams *params)
{
    return params->settled > 0;
}

bool fl_synth_make_temporal(FlSynth *synth, const FlCarried *carried, GError **error)
{
    const int l = fl_synth_finest_searched(synth);
    g_auto(FlNnf) down = {0};
    const FlNnf *previous;
    if (!fl_target_add_temporal(&synth->target, error) ||
        !previous_of_level(synth, &carried->nnf, l, &down, &previous, error) ||
        !make_temporal_level(synth, previous, l, error))
        return false;
    fl_target_temporal_pyramid(&synth->target, l);
    return !keeps(synth->params) || fl_target_keep(&synth->target, carried, synth->exemplar, error);
}

static double mean_energy(const FlSearch *search)
{
    return fl_mean_cost(search) / search->scale->unit;
}

static void vote(FlSynth *synth, const FlSearch *search, FlTargetLevel *target)
{
    gint64 time = g_get_monotonic_time();
    fl_vote(search->nnf, &target->blocks, search->level, search->kernels, fl_synth_sharpness(synth),
            3, target->colour, NULL);
    synth->seconds_vote += fl_lap(&time);
}

static void vote_and_blend(FlSynth *synth, const FlSearch *search, FlTargetLevel *target)
{
    vote(synth, search, target);
    fl_target_blend(target, search->params, search->scale, search->params->w_texture);
}

/* The costs of the field must be those of the target as it is, unless they are `stale`. */
static FlSearchCounts timed_search(FlSynth *synth, FlSearch *search, int sweeps, bool stale)
{
    gint64 time = g_get_monotonic_time();
    fl_occurrence_count(search->map, search->nnf, search->target);
    if (stale)
        fl_search_costs(search, NULL);
    const FlSearchCounts counts = fl_search_run(search, sweeps);
    synth->seconds_search += fl_lap(&time);
    return counts;
}

static void copy_blocks(const FlNnf *from, const FlBlocks *blocks, FlNnf *to)
{
    for (int k = 0; k < blocks->n; k++) {
        const FlRect block = blocks->block[k];
        for (int y = block.y; y < block.y + block.height; y++) {
            const size_t p = (size_t)y * (size_t)to->width + (size_t)block.x;
            memcpy(to->match + p, from->match + p, (size_t)block.width * sizeof *to->match);
        }
    }
}

/* Initialises the field of a level: from the coarser level, which may then be freed, from the
 * previous frame, or at random. */
static void initialise(FlSynth *synth, FlSearch *search, FlTargetLevel *target, int l,
                       const FlNnf *previous)
{
    const FlParams *params = synth->params;
    const bool coarsest = l == synth->n_levels - 1;
    const uint64_t key = fl_key(search->key, 1);
    if (!coarsest) {
        fl_nnf_upscale(&synth->nnf[l + 1], search->level, &target->blocks, search->nnf);
        fl_nnf_clear(&synth->nnf[l + 1]);
    } else if (previous && previous->match)
        copy_blocks(previous, &target->blocks, search->nnf);
    if (target->kept)
        fl_keep_matches(target, previous, search->nnf);
    fl_nnf_repair(search->nnf, search->level, target, params->rotate, key);
    if (coarsest && !previous) { // guides alone decide the first guess [P21 §4.2]
        fl_target_blend(target, params, &synth->scale, 0);
        timed_search(synth, search, fl_list_at(&params->patchmatch_iterations, 0), true);
    }
    if (l < fl_synth_finest_searched(synth))
        return;
    vote_and_blend(synth, search, target);
    fl_search_costs(search, coarsest ? NULL : previous);
}

/* Paper where no patch votes. The plane takes memory from here on: of the finest level, which is
 * the largest, once the coarser levels have gone. */
static void clear_colours(const FlSynth *synth, FlTargetLevel *level)
{
    float paper[3];
    for (int c = 0; c < 3; c++)
        paper[c] = synth->exemplar->paper[c] / 255.0f;
#pragma omp parallel for schedule(static)
    for (int k = 0; k < level->blocks.n; k++) {
        const FlRect block = level->blocks.block[k];
        for (int y = block.y; y < block.y + block.height; y++)
            for (int x = block.x; x < block.x + block.width; x++)
                memcpy(level->colour + 3 * ((size_t)y * (size_t)level->width + (size_t)x), paper,
                       sizeof paper);
    }
}

/* Search and vote in turn [F21 alg. 2]; the field comes with its costs. The next level votes anew,
 * so that the last vote is for the finest level's picture, or for energies. */
static bool optimise(FlSynth *synth, FlSearch *search, FlTargetLevel *target, int rounds,
                     int sweeps, FlLevelStats *stats, GError **error)
{
    const bool shown = target == &synth->target.level[0] && !synth->exemplar->enlargement;
    const bool last_counts = shown || synth->wants_energies;
    const uint64_t key = search->key;
    for (int round = 0; round < rounds; round++) {
        const bool last = round + 1 == rounds;
        if (fl_stop_asked(synth->stop, error))
            return false;
        search->key = fl_key(key, 2 + (uint64_t)round);
        const FlSearchCounts counts = timed_search(synth, search, sweeps, round > 0);
        stats->counts.drawn += counts.drawn;
        stats->counts.tried += counts.tried;
        stats->counts.accepted += counts.accepted;
        if (!last)
            vote_and_blend(synth, search, target);
        else if (last_counts)
            vote(synth, search, target);
    }
    search->key = key;
    return true;
}

/* The energy of the level's final field, and the terms of that energy. */
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

/* Matches that are good as they are cost little time: random tries rarely improve them, least of
 * all where the field comes from the coarser level or the frame before. */
static void settle(FlSearch *search, int level, bool first, bool coarsest)
{
    const float settled = search->params->settled;
    search->settled = (uint32_t)MIN(settled * fl_mean_cost(search), UINT32_MAX);
    search->near_px = first && coarsest ? INT_MAX : level > 0 ? NEAR_PX << level : 0;
    if (settled > 0 && level == 0)
        search->propagate_from = FINEST_RANDOM_SWEEPS;
}

/* A quarter of them in a first frame, which with the rounds of its coarser levels still ends better
 * than those after it; where every match is searched, as by the papers' presets, all. */
static int finest_sweeps(const FlParams *params, bool first)
{
    return first && params->settled > 0 ? (params->finest_sweeps + 3) / 4 : params->finest_sweeps;
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
                       .w_coh =
                           (double)params->w_coh *
                           (1 - (double)MAX(synth->exemplar->smoothness, synth->exemplar->melt)),
                       .kernels = &synth->kernels,
                       .nnf = &synth->nnf[l],
                       .cost = cost,
                       .carried = synth->moves ? previous : NULL,
                       .map = &map,
                       .changed = params->settled > 0 ? changed : NULL,
                       .key = fl_key(fl_key(synth->key, (uint64_t)synth->last.frame), (uint64_t)l)};
    const int from_coarsest = synth->n_levels - 1 - l;
    const bool finest = l == 0;
    const int rounds =
        finest    ? params->finest_rounds
        : shifted ? fl_list_at(&params->next_iterations, from_coarsest)
                  : fl_list_at(&params->opt_iterations, from_coarsest) * params->first_rounds;
    clear_colours(synth, target);
    initialise(synth, &search, target, l, previous);
    *stats = (FlLevelStats){.width = target->width, .height = target->height, .rounds = rounds};
    stats->pixels = target->n_inside[FL_SEGMENT_BORDER] + target->n_inside[FL_SEGMENT_INTERIOR];
    stats->energy_start = synth->wants_energies ? mean_energy(&search) : 0;
    settle(&search, l, !shifted, from_coarsest == 0);
    const int sweeps = finest ? finest_sweeps(params, !shifted)
                              : fl_list_at(&params->patchmatch_iterations, from_coarsest);
    if (!optimise(synth, &search, target, rounds, sweeps, stats, error))
        return false;
    if (rounds == 0 && finest && !synth->exemplar->enlargement) // the field has not been voted yet
        vote(synth, &search, target);
    if (synth->wants_energies)
        end_statistics(&search, target, stats);
    return true;
}

bool fl_synth_run_levels(FlSynth *synth, const FlNnf *shifted, FlFrameStats *stats, GError **error)
{
    synth->seconds_search = synth->seconds_vote = 0;
    stats->n_levels = synth->n_levels;
    for (int l = synth->n_levels - 1; l >= 0; l--) {
        gint64 time = g_get_monotonic_time();
        const FlTargetLevel *target = &synth->target.level[l];
        const size_t pixels = (size_t)target->n_tiles[FL_TILE_CLASSES] * FL_TILE * FL_TILE;
        const int threads = fl_schedule_set_threads(fl_schedule_threads_for(pixels));
        const bool done =
            run_level(synth, l, synth->last.valid ? shifted : NULL, &stats->level[l], error);
        (void)fl_schedule_set_threads(threads);
        if (!done)
            return false;
        if (l > 0) // the next one needs its field only
            fl_target_level_clear(&synth->target.level[l]);
        stats->level[l].seconds = fl_lap(&time);
    }
    stats->seconds_search = synth->seconds_search, stats->seconds_vote = synth->seconds_vote;
    return true;
}
