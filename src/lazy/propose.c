#include "lazy/retrieval_run.h"

#include "base/bits.h"
#include "base/rng.h"
#include <string.h>

#define WARM 3     // free targets of the warm start that are compared
#define ANYWHERE 3 // free targets by hash that are compared
#define CANDIDATES (WARM + 4 * (FL_RETRIEVAL_KEPT + 1) + ANYWHERE)

/* A source patch on its way to a target. */
typedef struct Proposal {
    _Alignas(32) FlFluidTexel patch[FL_PATCH_PIXELS];
    uint32_t source;
    int32_t target;
    uint32_t cost;
    uint64_t evaluations;
    int n_candidates;
    uint32_t candidate[CANDIDATES];
} Proposal;

static uint32_t tie_of(const FlRetrievalRun *run, uint32_t source, uint32_t target)
{
    return fl_hash32(source ^ fl_hash32(target ^ (uint32_t)run->pass_key));
}

const FlFluidTexel *fl_retrieval_patch(const FlFluidPicture *picture, uint32_t pixel)
{
    const uint32_t width = (uint32_t)picture->width;
    const ptrdiff_t x = pixel % width, y = pixel / width;
    return picture->pixel + (y - FL_PATCH_RADIUS) * picture->pitch + x - FL_PATCH_RADIUS;
}

void fl_retrieval_gather(const FlRetrievalRun *run, uint32_t source, FlFluidTexel *patch)
{
    const FlFluidPicture *picture = &run->in->source;
    const uint32_t pixel = fl_retrieval_pixel(run, source), width = (uint32_t)picture->width;
    const FlFluidTexel *middle =
        picture->pixel + (ptrdiff_t)(pixel / width) * picture->pitch + pixel % width;
    const FlSourceTurn *turn = &run->turn[source % run->n_turns];
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        patch[k] = middle[turn->offset[k]];
}

/* Takes a free target if it is nearer than the one in hand, or by hash where it is as near. */
static void consider(const FlRetrievalRun *run, Proposal *p, int32_t target, uint32_t cost)
{
    if (p->target != FL_NO_TARGET &&
        (cost > p->cost || (cost == p->cost && tie_of(run, p->source, (uint32_t)target) >=
                                                   tie_of(run, p->source, (uint32_t)p->target))))
        return;
    p->target = target, p->cost = cost;
}

static void try_target(const FlRetrievalRun *run, Proposal *p, uint32_t target)
{
    if ((int32_t)target == p->target)
        return;
    const FlFluidPicture *picture = &run->in->target;
    const uint32_t limit = p->target == FL_NO_TARGET ? UINT32_MAX - 1 : p->cost;
    p->evaluations++;
    consider(
        run, p, (int32_t)target,
        run->in->distance(p->patch, fl_retrieval_patch(picture, target), picture->pitch, limit));
}

/* Lets memory fetch the patch, while others are looked for. */
static void prefetch(const FlFluidPicture *picture, uint32_t target)
{
    const FlFluidTexel *row = fl_retrieval_patch(picture, target);
    for (int y = 0; y < FL_PATCH; y++, row += picture->pitch)
        for (int x = 0; x < FL_PATCH; x += 2)
            __builtin_prefetch(row + x);
}

/* Notes a target that is to be tried, unless it is taken or noted. */
static void add_target(const FlRetrievalRun *run, Proposal *p, uint32_t target)
{
    if (!fl_bit(run->is_free, target))
        return;
    for (int k = 0; k < p->n_candidates; k++)
        if (p->candidate[k] == target)
            return;
    prefetch(&run->in->target, target);
    p->candidate[p->n_candidates++] = target;
}

/* Notes the pixel beside a target to which its match continues. */
static void add_beside(const FlRetrievalRun *run, Proposal *p, int32_t target, int step)
{
    const int width = run->in->target.width, height = run->in->target.height;
    const int x = target % width - fl_retrieval_steps[step][0],
              y = target / width - fl_retrieval_steps[step][1];
    if (x >= 0 && y >= 0 && x < width && y < height)
        add_target(run, p, (uint32_t)(y * width + x));
}

/* Adds continuations of the targets that the neighbours of a source propose to or have won. */
static void add_neighbours(const FlRetrievalRun *run, Proposal *p)
{
    const int width = run->in->source.width, height = run->in->source.height;
    const int pixel = (int)fl_retrieval_pixel(run, p->source);
    const uint32_t quarters = p->source % run->n_turns;
    for (int k = 0; k < 4; k++) {
        const int8_t *step = run->turn[quarters].step[k];
        const int x = pixel % width + step[0], y = pixel / width + step[1];
        if (x < 0 || y < 0 || x >= width || y >= height)
            continue;
        const int32_t place = run->place_at[(size_t)y * (size_t)width + (size_t)x];
        if (place < 0)
            continue;
        const size_t s = (size_t)place * run->n_turns + quarters;
        if (run->target[s] != FL_NO_TARGET)
            add_beside(run, p, run->target[s], k);
        const int32_t *won = run->won + s * run->n_kept;
        for (uint32_t n = 0; n < run->n_kept && won[n] != FL_NO_TARGET; n++)
            add_beside(run, p, won[n], k);
    }
}

/* Places in the list of free targets, which memory then fetches. */
static void choose_anywhere(const FlRetrievalRun *run, FlRng *rng, uint32_t places[ANYWHERE])
{
    for (int n = 0; n < ANYWHERE; n++) {
        places[n] = fl_rng_below(rng, run->n_open);
        __builtin_prefetch(run->open + places[n]);
    }
}

/* Adds free targets chosen by hash from the list, which has few taken ones. If most targets are
 * taken, windows rarely contain a free target. */
static void add_anywhere(const FlRetrievalRun *run, Proposal *p, const uint32_t places[ANYWHERE])
{
    for (int n = 0; n < ANYWHERE; n++) {
        uint32_t k = places[n];
        while (!fl_bit(run->is_free, run->open[k]))
            k = (k + 1) % run->n_open;
        add_target(run, p, run->open[k]);
    }
}

/* Those that are taken leave the list, which then begins with the free ones that were found. */
static void add_warm(const FlRetrievalRun *run, Proposal *p)
{
    uint32_t found[WARM] = {0}, n = 0, k = run->warm_first[p->source];
    for (; k < run->warm_end[p->source] && n < WARM; k++)
        if (fl_bit(run->is_free, run->warm[k])) {
            found[n] = run->warm[k];
            add_target(run, p, found[n++]);
        }
    memcpy(run->warm + k - n, found, n * sizeof *found);
    run->warm_first[p->source] = k - n;
}

/* Windows around the target in hand, each half as large as the one before. */
static void try_windows(const FlRetrievalRun *run, Proposal *p, FlRng *rng)
{
    const int width = run->in->target.width, height = run->in->target.height;
    for (int reach = MAX(width, height) / 8; reach >= 1; reach /= 2) {
        const uint32_t side = 2 * (uint32_t)reach + 1;
        const int x = p->target % width - reach + (int)fl_rng_below(rng, side);
        const int y = p->target / width - reach + (int)fl_rng_below(rng, side);
        if (x >= 0 && y >= 0 && x < width && y < height &&
            fl_bit(run->is_free, (uint32_t)(y * width + x)))
            try_target(run, p, (uint32_t)(y * width + x));
    }
}

static void search(const FlRetrievalRun *run, Proposal *p, FlRng *rng)
{
    const int32_t last = run->target[p->source];
    uint32_t places[ANYWHERE];
    choose_anywhere(run, rng, places);
    if (last != FL_NO_TARGET && fl_bit(run->is_free, (uint32_t)last))
        p->target = last, p->cost = run->cost[p->source];
    else
        add_warm(run, p);
    add_neighbours(run, p);
    add_anywhere(run, p, places);
    for (int k = 0; k < p->n_candidates; k++)
        try_target(run, p, p->candidate[k]);
    try_windows(run, p, rng);
}

static void propose(FlRetrievalRun *run, uint32_t source, uint64_t *evaluations)
{
    if (!fl_retrieval_is_eligible(run, source)) {
        run->target[source] = FL_NO_TARGET;
        return;
    }
    Proposal p = {.source = source, .target = FL_NO_TARGET};
    FlRng rng = {fl_key(run->pass_key, source)};
    fl_retrieval_gather(run, source, p.patch);
    search(run, &p, &rng);
    run->target[source] = p.target, run->cost[source] = p.cost;
    *evaluations += p.evaluations;
}

static uint64_t propose_in_tile(FlRetrievalRun *run, int tile)
{
    const uint32_t first = run->tile_first[tile], end = run->tile_first[tile + 1];
    uint64_t evaluations = 0;
    for (uint32_t k = first; k < end; k++) {
        const uint32_t place = run->tile_places[run->backwards ? end - 1 - (k - first) : k];
        for (uint32_t turn = 0; turn < run->n_turns; turn++)
            propose(run, place * run->n_turns + turn, &evaluations);
    }
    return evaluations;
}

/* Tiles of one colour of the chequerboard read those of the other only, and these rest. */
void fl_propose_all(FlRetrievalRun *run)
{
    uint64_t evaluations = 0;
    for (int colour = 0; colour < 2; colour++) {
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : evaluations) if (run->n_sources > 4096)
        for (int tile = 0; tile < run->n_tiles; tile++)
            if (((tile % run->tile_columns + tile / run->tile_columns) & 1) == colour)
                evaluations += propose_in_tile(run, tile);
    }
    run->done->evaluations += evaluations;
}
