#include "synth/patchmatch.h"

#include "base/schedule.h"
#include "synth/tile_search.h"
#include <sched.h>

#define PATIENCE 1000 // spins before a thread yields

/*
 * The steps of a search are the classes of each sweep in turn. Threads take the tiles of a step
 * from a counter; the last thread to finish a step refreshes the map and opens the next step. One
 * parallel region does it all, with a barrier of its own that soon yields the processor: OpenMP's
 * barriers spin, and sixteen of them per sweep cost ten times the search on a loaded machine.
 */
typedef struct Team {
    const FlTileSearch *tile_search;
    int sweeps, step; // step: sweep * FL_TILE_CLASSES + place in the order of classes
    int next_tile, end_tile;
    int n_threads, n_waiting;
    FlSearchCounts counts;
} Team;

static bool is_backwards(int step)
{
    return step / FL_TILE_CLASSES & 1;
}

static void open_step(Team *team, int step)
{
    const int place = step % FL_TILE_CLASSES;
    const int class = is_backwards(step) ? FL_TILE_CLASSES - 1 - place : place;
    const FlTargetLevel *target = team->tile_search->search->target;
    team->next_tile = target->n_tiles[class];
    team->end_tile = target->n_tiles[class + 1];
    __atomic_store_n(&team->step, step, __ATOMIC_RELEASE);
}

static void finish_step(Team *team, int step)
{
    if (__atomic_add_fetch(&team->n_waiting, 1, __ATOMIC_ACQ_REL) == team->n_threads) {
        team->n_waiting = 0;
        fl_occurrence_refresh(team->tile_search->search->map);
        open_step(team, step + 1);
        return;
    }
    for (int spins = 0; __atomic_load_n(&team->step, __ATOMIC_ACQUIRE) == step; spins++)
        if (spins > PATIENCE)
            sched_yield();
}

static void work(Team *team)
{
    const FlSearch *search = team->tile_search->search;
    FlSearchCounts own = {0};
    for (int step = 0; step < team->sweeps * FL_TILE_CLASSES; step++) {
        int k;
        while ((k = __atomic_fetch_add(&team->next_tile, FL_TILES_AT_ONCE, __ATOMIC_RELAXED)) <
               team->end_tile)
            fl_tile_search_run(team->tile_search, search->target->tiles + k,
                               MIN(FL_TILES_AT_ONCE, team->end_tile - k), step / FL_TILE_CLASSES,
                               &own);
        finish_step(team, step);
    }
    __atomic_fetch_add(&team->counts.drawn, own.drawn, __ATOMIC_RELAXED);
    __atomic_fetch_add(&team->counts.tried, own.tried, __ATOMIC_RELAXED);
    __atomic_fetch_add(&team->counts.accepted, own.accepted, __ATOMIC_RELAXED);
}

FlSearchCounts fl_search_run(FlSearch *search, int sweeps)
{
    FlTileSearch tile_search;
    if (search->changed)
        memset(search->changed, 0, (size_t)search->nnf->width * search->nnf->height);
    fl_tile_search_init(&tile_search, search);
    Team team = {.tile_search = &tile_search, .sweeps = sweeps};
    open_step(&team, 0);
#pragma omp parallel
    {
#pragma omp single
        team.n_threads = fl_schedule_team_size();
        work(&team);
    }
    return team.counts;
}
