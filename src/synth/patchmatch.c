#include "synth/patchmatch.h"

#include "base/rng.h"
#include "synth/visit.h"
#include <sched.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#define FEW_TILES (4 * FL_TILE_CLASSES) // with fewer, threads wait more than they work
#define PATIENCE 200000                 // looks at the step, 0.1 ms, before others may run

/* The source flow, rotated, opposes the target's: past and future motion change roles [F21 §3.3].
 */
static bool opposes(uint8_t turn)
{
    return turn > 64 && turn < 192;
}

uint32_t fl_patch_cost(const FlSearch *search, const FlTargetPatch *patch, uint8_t target_angle,
                       const FlTexel *centre, uint8_t theta, uint32_t limit)
{
    const uint8_t turn = (uint8_t)(theta + centre->c[FL_CH_ANGLE] - target_angle);
    const uint32_t direction = search->params->rotate ? search->scale->direction[turn] : 0;
    if (direction > limit)
        return direction;
    return direction + search->kernels->patch_distance(centre, search->level->offsets[theta],
                                                       opposes(turn), patch->guide,
                                                       &search->target->rest, limit - direction);
}

uint32_t fl_match_cost(const FlSearch *search, int x, int y, FlMatch match)
{
    FlTargetPatch patch;
    fl_target_gather(search->target, x, y, &patch);
    const FlTexel *centre =
        fl_exemplar_at(search->level, fl_match_x(match), fl_match_y(match), match.frame);
    return fl_patch_cost(search, &patch,
                         search->target->angle[(size_t)y * search->target->width + x], centre,
                         match.theta, UINT32_MAX >> 1);
}

void fl_search_costs(FlSearch *search, const FlNnf *nnf, uint32_t *cost)
{
#pragma omp parallel for schedule(dynamic, 8)
    for (int y = 0; y < nnf->height; y++)
        for (int x = 0; x < nnf->width; x++) {
            const size_t p = (size_t)y * nnf->width + x;
            cost[p] = nnf->match[p].frame == FL_NO_MATCH
                          ? UINT32_MAX
                          : fl_match_cost(search, x, y, nnf->match[p]);
        }
}

/*
 * The steps of a search: the classes of each sweep in turn. Threads take tiles of a step from a
 * counter; whoever finishes a step last refreshes the map and opens the next. All of it happens in
 * one parallel region with a barrier of its own, which gives the processor away after a while:
 * OpenMP's barriers spin, and sixteen of them per sweep cost ten times the search on a machine that
 * has other things to do. Whoever gives it away gets it back milliseconds later, so a tile's time
 * must be waited for.
 */
typedef struct Crew {
    const FlVisitPlan *plan;
    int sweeps, step; // step: sweep * FL_TILE_CLASSES + place in the order of classes
    int next_tile, end_tile;
    int n_threads, n_waiting;
    FlSearchCounts counts;
} Crew;

static int team_size(void)
{
#ifdef _OPENMP
    return omp_get_num_threads();
#else
    return 1;
#endif
}

static bool is_backwards(int step)
{
    return step / FL_TILE_CLASSES & 1;
}

static void open_step(Crew *crew, int step)
{
    const int place = step % FL_TILE_CLASSES;
    const int class = is_backwards(step) ? FL_TILE_CLASSES - 1 - place : place;
    const FlTargetLevel *target = crew->plan->search->target;
    crew->next_tile = target->n_tiles[class];
    crew->end_tile = target->n_tiles[class + 1];
    __atomic_store_n(&crew->step, step, __ATOMIC_RELEASE);
}

static void finish_step(Crew *crew, int step)
{
    if (__atomic_add_fetch(&crew->n_waiting, 1, __ATOMIC_ACQ_REL) == crew->n_threads) {
        crew->n_waiting = 0;
        fl_occurrence_refresh(crew->plan->search->map);
        open_step(crew, step + 1);
        return;
    }
    for (int spins = 0; __atomic_load_n(&crew->step, __ATOMIC_ACQUIRE) == step; spins++)
        if (spins > PATIENCE)
            sched_yield();
}

static void work(Crew *crew)
{
    const FlSearch *search = crew->plan->search;
    FlSearchCounts own = {0};
    for (int step = 0; step < crew->sweeps * FL_TILE_CLASSES; step++) {
        const uint64_t key = fl_key(search->key, (uint64_t)(step / FL_TILE_CLASSES));
        int k;
        while ((k = __atomic_fetch_add(&crew->next_tile, FL_TILES_AT_ONCE, __ATOMIC_RELAXED)) <
               crew->end_tile)
            fl_visit_tiles(crew->plan, search->target->tiles + k,
                           MIN(FL_TILES_AT_ONCE, crew->end_tile - k), is_backwards(step), key,
                           &own);
        finish_step(crew, step);
    }
    __atomic_fetch_add(&crew->counts.drawn, own.drawn, __ATOMIC_RELAXED);
    __atomic_fetch_add(&crew->counts.tried, own.tried, __ATOMIC_RELAXED);
    __atomic_fetch_add(&crew->counts.accepted, own.accepted, __ATOMIC_RELAXED);
}

FlSearchCounts fl_search_run(FlSearch *search, int sweeps)
{
    FlVisitPlan plan;
    fl_visit_plan_init(&plan, search);
    Crew crew = {.plan = &plan, .sweeps = sweeps};
    open_step(&crew, 0);
#pragma omp parallel if (search->target->n_tiles[FL_TILE_CLASSES] >= FEW_TILES)
    {
#pragma omp single
        crew.n_threads = team_size();
        work(&crew);
    }
    return crew.counts;
}
