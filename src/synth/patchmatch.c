#include "synth/patchmatch.h"

#include "base/rng.h"
#include "base/schedule.h"
#include "synth/tile_search.h"
#include <sched.h>

#define FEW_TILES (4 * FL_TILE_CLASSES) // with fewer, threads wait more than they work
#define PATIENCE 200000                 // looks at the step, 0.1 ms, before others may run

/*
 * The steps of a search: the classes of each sweep in turn. Threads take tiles of a step from a
 * counter; whoever finishes a step last refreshes the map and opens the next. All of it happens in
 * one parallel region with a barrier of its own, which gives the processor away after a while:
 * OpenMP's barriers spin, and sixteen of them per sweep cost ten times the search on a machine that
 * has other things to do. Whoever gives it away gets it back milliseconds later, so a tile's time
 * must be waited for.
 */
typedef struct Crew {
    const FlTileSearch *plan;
    int sweeps, step; // step: sweep * FL_TILE_CLASSES + place in the order of classes
    int next_tile, end_tile;
    int n_threads, n_waiting;
    FlSearchCounts counts;
} Crew;

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
            fl_tile_search_run(crew->plan, search->target->tiles + k,
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
    FlTileSearch plan;
    fl_tile_search_init(&plan, search);
    Crew crew = {.plan = &plan, .sweeps = sweeps};
    open_step(&crew, 0);
#pragma omp parallel if (search->target->n_tiles[FL_TILE_CLASSES] >= FEW_TILES)
    {
#pragma omp single
        crew.n_threads = fl_schedule_team_size();
        work(&crew);
    }
    return crew.counts;
}
