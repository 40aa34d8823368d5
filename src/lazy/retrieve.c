#include "lazy/retrieve.h"

#include "base/alloc.h"
#include "base/bits.h"
#include "base/rng.h"
#include "base/schedule.h"
#include "lazy/cost_table.h"
#include "lazy/nearest.h"
#include <string.h>

#define TURNS 4
#define TILE 16          // side of a tile of source pixels; they are searched as a chequerboard
#define TABLE (1u << 18) // with as many pairs at most, all distances are known
#define FEW_TARGETS 32   // free ones: all distances to them are known,
#define FEW_SHARE 100    // as where they are a share of all,
#define FEW_PAIRS 3      // unless there are more pairs than so many a target
#define WARM 3           // free targets of the warm start that are compared
#define CONTINUED 4      // won targets of a neighbour that are continued
#define ANYWHERE 3       // free targets by hash that are compared
#define CANDIDATES (WARM + 4 * (CONTINUED + 1) + ANYWHERE)
#define NONE (-1)
#define NO_OFFER UINT64_MAX

/* Offsets in the order of a patch's rows, and steps to the four neighbours, in a turned source. */
typedef struct Turn {
    int32_t offset[FL_PATCH_PIXELS]; // in pixels of the source picture
    int8_t step[4][2];               // in source pixels; of the target it is steps[]
} Turn;

static const int8_t steps[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};

/* A source that may still be used, and its row in the table. */
typedef struct Left {
    uint32_t source, row;
} Left;

/* Source patch s is place s / n_turns, turned by s % n_turns quarters. A target is its pixel. */
typedef struct Run {
    const FlRetrieval *in;
    uint32_t n_turns, n_sources, n_targets;
    Turn turn[TURNS];
    int32_t *place_at; // by pixel of the source; NONE
    int32_t *target;   // [n_sources]: what it proposes to
    uint32_t *cost;    // of that
    int32_t *won;      // [n_sources][n_kept]: the last targets won, newest first; NONE
    uint32_t n_kept;
    uint32_t *warm;                  // targets of the warm start, source by source,
    uint32_t *warm_first, *warm_end; // where those of a source stand; the first may be taken
    uint64_t *is_free;               // by target, a bit each
    uint32_t *open;                  // free targets in scan order, and a few that are no longer
    uint32_t n_open, n_free;
    uint64_t *offer;                // by target: the least cost << 32 | a hash of the source
    uint32_t *cell;                 // by source: what it counts for
    uint32_t *use;                  // by cell
    uint32_t n_cells, quota, extra; // K, and the cells that may still be used K + 1 times
    uint32_t *tile_places, *tile_first;
    int tile_columns, n_tiles;
    FlCostTable table; // of the end, when few pairs are left; its costs are NULL until then
    Left *left;        // then: in the order of the sources
    uint32_t n_left;
    uint64_t pass_key;
    bool backwards; // the order of the pass
    FlRetrieved *done;
} Run;

static void run_clear(Run *run)
{
    void *const arrays[] = {run->place_at,   run->target,     run->cost,     run->won,
                            run->warm,       run->warm_first, run->warm_end, run->is_free,
                            run->open,       run->offer,      run->cell,     run->tile_places,
                            run->tile_first, run->use,        run->left};
    for (size_t k = 0; k < G_N_ELEMENTS(arrays); k++)
        free(arrays[k]);
    fl_cost_table_clear(&run->table);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Run, run_clear)

/* ---- preparation ----------------------------------------------------------------------------- */

static void turn_init(Turn *turn, int quarters, ptrdiff_t pitch)
{
    const uint8_t theta = (uint8_t)(quarters * FL_ANGLES / TURNS);
    int x, y;
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        fl_unrotate(theta, k % FL_PATCH - FL_PATCH_RADIUS, k / FL_PATCH - FL_PATCH_RADIUS, &x, &y);
        turn->offset[k] = (int32_t)(y / 16 * pitch + x / 16);
    }
    for (int k = 0; k < 4; k++) {
        fl_unrotate(theta, steps[k][0], steps[k][1], &x, &y);
        turn->step[k][0] = (int8_t)(x / 16), turn->step[k][1] = (int8_t)(y / 16);
    }
}

static int32_t *number_places(const FlRetrieval *in, GError **error)
{
    const size_t pixels = (size_t)in->source.width * (size_t)in->source.height;
    int32_t *at = fl_alloc(pixels, sizeof *at, "a retrieval", error);
    if (!at)
        return NULL;
    memset(at, 0xff, pixels * sizeof *at);
    for (size_t k = 0; k < in->n_sources; k++)
        at[in->sources[k]] = (int32_t)k;
    return at;
}

static bool alloc_run(Run *run, GError **error)
{
    const FlRetrieval *in = run->in;
    const size_t s = run->n_sources, pixels = (size_t)in->target.width * (size_t)in->target.height;
    const char *what = "a retrieval";
    return (run->place_at = number_places(in, error)) &&
           (run->target = fl_alloc(s, sizeof(int32_t), what, error)) &&
           (run->cost = fl_alloc(s, sizeof(uint32_t), what, error)) &&
           (run->won = fl_alloc(s * run->n_kept, sizeof(int32_t), what, error)) &&
           (run->warm = fl_alloc(run->n_targets, sizeof(uint32_t), what, error)) &&
           (run->warm_first = fl_alloc(s + 1, sizeof(uint32_t), what, error)) &&
           (run->warm_end = fl_alloc(s, sizeof(uint32_t), what, error)) &&
           (run->cell = fl_alloc(s, sizeof(uint32_t), what, error)) &&
           (run->use = fl_alloc(s, sizeof(uint32_t), what, error)) &&
           (run->is_free = fl_bits_new(pixels, what, error)) &&
           (run->open = fl_alloc(run->n_targets, sizeof(uint32_t), what, error)) &&
           (run->offer = fl_alloc_scratch(pixels, sizeof(uint64_t), what, error)) &&
           (run->tile_places = fl_alloc(in->n_sources, sizeof(uint32_t), what, error)) &&
           (run->tile_first = fl_alloc((size_t)run->n_tiles + 2, sizeof(uint32_t), what, error));
}

static uint32_t pixel_of(const Run *run, uint32_t source)
{
    return run->in->sources[source / run->n_turns];
}

/* Sorts the places into tiles; in a tile they keep their order. */
static void fill_tiles(Run *run)
{
    const uint32_t width = (uint32_t)run->in->source.width;
    uint32_t *first = run->tile_first + 1; // of the next tile, while they are filled
    for (int pass = 0; pass < 2; pass++) {
        for (uint32_t k = 0; k < run->in->n_sources; k++) {
            const uint32_t p = run->in->sources[k];
            const uint32_t tile = p / width / TILE * (uint32_t)run->tile_columns + p % width / TILE;
            if (pass == 0)
                first[tile + 1]++;
            else
                run->tile_places[first[tile]++] = k;
        }
        for (int t = 0; t < run->n_tiles && pass == 0; t++)
            first[t + 1] += first[t];
    }
}

/* Blocks of as many places a side that there are as many blocks as targets at most; 1: patches. */
static uint32_t block_side(const Run *run)
{
    uint32_t side = 1;
    const bool blocks = run->in->uniform == FL_UNIFORM_BLOCK ||
                        (run->in->uniform == FL_UNIFORM_AUTO && run->n_sources > run->n_targets);
    while (blocks && run->n_sources / (side * side) > run->n_targets)
        side++;
    return side;
}

/* What the sources count for, and how often that may be used. */
static bool fill_cells(Run *run, GError **error)
{
    const uint32_t side = block_side(run), width = (uint32_t)run->in->source.width;
    const uint32_t columns = width / side + 1;
    const size_t n = (size_t)columns * ((uint32_t)run->in->source.height / side + 1) * run->n_turns;
    g_autofree uint32_t *number = fl_alloc(side > 1 ? n : 1, sizeof *number, "a retrieval", error);
    if (!number)
        return false;
    for (uint32_t s = 0; s < run->n_sources; s++) {
        const uint32_t p = pixel_of(run, s), row = p / width / side, column = p % width / side;
        const size_t block = ((size_t)row * columns + column) * run->n_turns + s % run->n_turns;
        if (side > 1 && number[block] == 0)
            number[block] = ++run->n_cells;
        run->cell[s] = side > 1 ? number[block] - 1 : s;
    }
    if (side == 1)
        run->n_cells = run->n_sources;
    const uint32_t cells = MAX(run->n_cells, 1);
    run->quota = run->n_targets / cells, run->extra = run->n_targets % cells;
    return true;
}

/* The source of a match, as a number; NONE. */
static int32_t source_of(const Run *run, FlMatch m)
{
    const int x = fl_match_x(m), y = fl_match_y(m), quarter = FL_ANGLES / TURNS;
    if (m.frame == FL_NO_MATCH || x >= run->in->source.width || y >= run->in->source.height)
        return NONE;
    const int32_t place = run->place_at[(size_t)y * (size_t)run->in->source.width + (size_t)x];
    const uint32_t turn = (uint32_t)(m.theta + quarter / 2) / (uint32_t)quarter % run->n_turns;
    return place < 0 ? NONE : (int32_t)((uint32_t)place * run->n_turns + turn);
}

/* Sorts the targets of the warm start by source; of one they stand in their order. */
static void start_warm(Run *run, const FlNnf *nnf)
{
    uint32_t n = 0;
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const int32_t s = source_of(run, nnf->match[run->in->targets[j]]);
        if (s != NONE)
            run->warm_end[s]++;
    }
    for (uint32_t s = 0; s < run->n_sources; s++) {
        run->warm_first[s] = n;
        n += run->warm_end[s], run->warm_end[s] = run->warm_first[s];
    }
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const int32_t s = source_of(run, nnf->match[run->in->targets[j]]);
        if (s != NONE)
            run->warm[run->warm_end[s]++] = run->in->targets[j];
    }
}

/* ---- the nearest free target ----------------------------------------------------------------- */

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

static uint32_t tie_of(const Run *run, uint32_t source, uint32_t target)
{
    return fl_hash32(source ^ fl_hash32(target ^ (uint32_t)run->pass_key));
}

static const FlFluidTexel *patch_at(const FlFluidPicture *picture, uint32_t pixel)
{
    const uint32_t width = (uint32_t)picture->width;
    const ptrdiff_t x = pixel % width, y = pixel / width;
    return picture->pixel + (y - FL_PATCH_RADIUS) * picture->pitch + x - FL_PATCH_RADIUS;
}

static void gather_source(const Run *run, uint32_t source, FlFluidTexel *patch)
{
    const FlFluidPicture *picture = &run->in->source;
    const uint32_t pixel = pixel_of(run, source), width = (uint32_t)picture->width;
    const FlFluidTexel *middle =
        picture->pixel + (ptrdiff_t)(pixel / width) * picture->pitch + pixel % width;
    const Turn *turn = &run->turn[source % run->n_turns];
    for (int k = 0; k < FL_PATCH_PIXELS; k++)
        patch[k] = middle[turn->offset[k]];
}

/* Takes a free target if it is nearer than the one in hand, or by hash where it is as near. */
static void consider(const Run *run, Proposal *p, int32_t target, uint32_t cost)
{
    if (p->target != NONE &&
        (cost > p->cost || (cost == p->cost && tie_of(run, p->source, (uint32_t)target) >=
                                                   tie_of(run, p->source, (uint32_t)p->target))))
        return;
    p->target = target, p->cost = cost;
}

static void try_target(const Run *run, Proposal *p, uint32_t target)
{
    if ((int32_t)target == p->target)
        return;
    const FlFluidPicture *picture = &run->in->target;
    const uint32_t limit = p->target == NONE ? UINT32_MAX - 1 : p->cost;
    p->evaluations++;
    consider(run, p, (int32_t)target,
             run->in->distance(p->patch, patch_at(picture, target), picture->pitch, limit));
}

/* Lets memory fetch the patch, while others are looked for. */
static void prefetch(const FlFluidPicture *picture, uint32_t target)
{
    const FlFluidTexel *row = patch_at(picture, target);
    for (int y = 0; y < FL_PATCH; y++, row += picture->pitch)
        for (int x = 0; x < FL_PATCH; x += 2)
            __builtin_prefetch(row + x);
}

/* Notes a target that is to be tried, unless it is taken or noted. */
static void add_target(const Run *run, Proposal *p, uint32_t target)
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
static void add_beside(const Run *run, Proposal *p, int32_t target, int step)
{
    const int width = run->in->target.width, height = run->in->target.height;
    const int x = target % width - steps[step][0], y = target / width - steps[step][1];
    if (x >= 0 && y >= 0 && x < width && y < height)
        add_target(run, p, (uint32_t)(y * width + x));
}

/* What the neighbours of a source propose to and have won, continued. */
static void add_neighbours(const Run *run, Proposal *p)
{
    const int width = run->in->source.width, height = run->in->source.height;
    const int pixel = (int)pixel_of(run, p->source);
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
        if (run->target[s] != NONE)
            add_beside(run, p, run->target[s], k);
        const int32_t *won = run->won + s * run->n_kept;
        for (uint32_t n = 0; n < run->n_kept && won[n] != NONE; n++)
            add_beside(run, p, won[n], k);
    }
}

/* Places in the list of free targets, which memory then fetches. */
static void choose_anywhere(const Run *run, FlRng *rng, uint32_t places[ANYWHERE])
{
    for (int n = 0; n < ANYWHERE; n++) {
        places[n] = fl_rng_below(rng, run->n_open);
        __builtin_prefetch(run->open + places[n]);
    }
}

/* Free targets by hash: the list has few that are not. Where most are taken, windows hit none. */
static void add_anywhere(const Run *run, Proposal *p, const uint32_t places[ANYWHERE])
{
    for (int n = 0; n < ANYWHERE; n++) {
        uint32_t k = places[n];
        while (!fl_bit(run->is_free, run->open[k]))
            k = (k + 1) % run->n_open;
        add_target(run, p, run->open[k]);
    }
}

/* Those that are taken leave the list, which then begins with the free ones that were found. */
static void add_warm(const Run *run, Proposal *p)
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
static void try_windows(const Run *run, Proposal *p, FlRng *rng)
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

static void search(const Run *run, Proposal *p, FlRng *rng)
{
    const int32_t last = run->target[p->source];
    uint32_t places[ANYWHERE];
    choose_anywhere(run, rng, places);
    if (last != NONE && fl_bit(run->is_free, (uint32_t)last))
        p->target = last, p->cost = run->cost[p->source];
    else
        add_warm(run, p);
    add_neighbours(run, p);
    add_anywhere(run, p, places);
    for (int k = 0; k < p->n_candidates; k++)
        try_target(run, p, p->candidate[k]);
    try_windows(run, p, rng);
}

static bool is_eligible(const Run *run, uint32_t source)
{
    const uint32_t use = run->use[run->cell[source]];
    return use < run->quota || (use == run->quota && run->extra > 0);
}

static void propose(Run *run, uint32_t source, uint64_t *evaluations)
{
    if (!is_eligible(run, source)) {
        run->target[source] = NONE;
        return;
    }
    Proposal p = {.source = source, .target = NONE};
    FlRng rng = {fl_key(run->pass_key, source)};
    gather_source(run, source, p.patch);
    search(run, &p, &rng);
    run->target[source] = p.target, run->cost[source] = p.cost;
    *evaluations += p.evaluations;
}

static uint64_t propose_in_tile(Run *run, int tile)
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
static void propose_all(Run *run)
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

/* ---- targets choose -------------------------------------------------------------------------- */

/* A source that has won its target; the key is the cost and a hash that settles ties. */
typedef struct Winner {
    uint64_t key;
    uint32_t source, cell;
} Winner;

static uint64_t offer_key(const Run *run, uint32_t source)
{
    const uint32_t target = (uint32_t)run->target[source];
    return (uint64_t)run->cost[source] << 32 |
           (source ^ fl_hash32(target ^ (uint32_t)(run->pass_key >> 32)));
}

static int compare_keys(const void *a, const void *b)
{
    const Winner *v = a, *w = b;
    return v->key < w->key ? -1 : v->key > w->key;
}

static int compare_cells(const void *a, const void *b)
{
    const Winner *v = a, *w = b;
    return v->cell != w->cell ? (v->cell < w->cell ? -1 : 1) : compare_keys(a, b);
}

static void assign(Run *run, const Winner *winner, FlNnf *nnf)
{
    const uint32_t s = winner->source, pixel = pixel_of(run, s);
    const int32_t target = run->target[s];
    const uint32_t width = (uint32_t)run->in->source.width;
    nnf->match[target] = (FlMatch){.x_16 = (uint16_t)(16 * (pixel % width)),
                                   .y_16 = (uint16_t)(16 * (pixel / width)),
                                   .theta = (uint8_t)(s % run->n_turns * (FL_ANGLES / TURNS))};
    fl_bit_clear(run->is_free, (uint32_t)target);
    run->n_free--;
    run->use[winner->cell]++;
    int32_t *won = run->won + (size_t)s * run->n_kept;
    memmove(won + 1, won, (run->n_kept - 1) * sizeof *won);
    won[0] = target;
    run->done->energy += (double)(winner->key >> 32) / ((double)FL_FLUID_ONE * FL_FLUID_ONE);
}

/* Every target's best offer; then the sources whose offer it is. */
static uint32_t find_winners(Run *run, Winner *winners)
{
    const bool few = run->table.cost;
    const uint32_t sources = few ? run->n_left : run->n_sources;
    uint32_t n = 0;
    for (uint32_t k = 0; k < sources; k++) {
        const uint32_t s = few ? run->left[k].source : k;
        if (run->target[s] != NONE)
            run->offer[run->target[s]] = MIN(run->offer[run->target[s]], offer_key(run, s));
    }
    for (uint32_t k = 0; k < sources; k++) {
        const uint32_t s = few ? run->left[k].source : k;
        if (run->target[s] != NONE && run->offer[run->target[s]] == offer_key(run, s))
            winners[n++] = (Winner){offer_key(run, s), s, run->cell[s]};
    }
    for (uint32_t k = 0; k < n; k++)
        run->offer[run->target[winners[k].source]] = NO_OFFER;
    return n;
}

/* Assigns those whose cells have room up to K, then the nearest of those that may go beyond. */
static void settle(Run *run, Winner *winners, uint32_t n, FlNnf *nnf)
{
    uint32_t n_beyond = 0, last_beyond = UINT32_MAX;
    if (run->n_cells < run->n_sources)
        qsort(winners, n, sizeof *winners, compare_cells);
    for (uint32_t k = 0; k < n; k++) {
        const Winner w = winners[k];
        if (run->use[w.cell] < run->quota)
            assign(run, &w, nnf);
        else if (w.cell != last_beyond)
            winners[n_beyond++] = w, last_beyond = w.cell;
    }
    if (n_beyond > run->extra)
        qsort(winners, n_beyond, sizeof *winners, compare_keys);
    n_beyond = MIN(n_beyond, run->extra);
    for (uint32_t k = 0; k < n_beyond; k++)
        assign(run, &winners[k], nnf);
    run->extra -= n_beyond;
}

/* ---- passes ---------------------------------------------------------------------------------- */

/* Drops the targets that are taken, as soon as they are more than a few. */
static void compact_open(Run *run)
{
    uint32_t n = 0;
    if (run->n_free > run->n_open - run->n_open / 8)
        return;
    for (uint32_t k = 0; k < run->n_open; k++)
        if (fl_bit(run->is_free, run->open[k]))
            run->open[n++] = run->open[k];
    run->n_open = n;
}

static void fill_row(Run *run, uint32_t row)
{
    _Alignas(32) FlFluidTexel patch[FL_PATCH_PIXELS];
    const FlFluidPicture *picture = &run->in->target;
    gather_source(run, run->left[row].source, patch);
    for (uint32_t j = 0; j < run->table.n_columns; j++)
        run->table.cost[(size_t)row * run->table.n_columns + j] = run->in->distance(
            patch, patch_at(picture, run->table.target[j]), picture->pitch, UINT32_MAX);
}

/* All distances between the sources and the targets that are left. */
static bool make_table(Run *run, uint32_t n_eligible, GError **error)
{
    uint32_t n = 0;
    if (!(run->left = fl_alloc(n_eligible, sizeof *run->left, "distances", error)) ||
        !fl_cost_table_init(&run->table, n_eligible, run->n_free, run->in->key, error))
        return false;
    for (uint32_t s = 0; s < run->n_sources; s++)
        if (is_eligible(run, s)) {
            run->left[run->n_left] = (Left){s, run->n_left};
            run->n_left++;
        }
    for (uint32_t k = 0; k < run->n_open; k++)
        if (fl_bit(run->is_free, run->open[k]))
            run->table.target[n++] = run->open[k];
#pragma omp parallel for schedule(dynamic, 16) if (run->n_left > 64)
    for (uint32_t row = 0; row < run->n_left; row++)
        fill_row(run, row);
    run->done->evaluations += (uint64_t)run->n_left * run->n_free;
    return true;
}

/* Whether few enough pairs are left for a table. */
static bool are_few(const Run *run, uint32_t n_eligible)
{
    const uint64_t pairs = (uint64_t)n_eligible * run->n_free;
    const bool few = run->n_free < MAX(FEW_TARGETS, run->n_targets / FEW_SHARE);
    return (uint64_t)run->n_sources * run->n_targets <= TABLE ||
           (few && pairs <= FEW_PAIRS * (uint64_t)run->n_targets);
}

static bool open_pass(Run *run, GError **error)
{
    uint32_t n = 0;
    run->backwards = run->done->passes & 1;
    if (!run->table.cost) {
        for (uint32_t s = 0; s < run->n_sources; s++)
            n += is_eligible(run, s);
        compact_open(run);
        return !are_few(run, n) || make_table(run, n, error);
    }
    for (uint32_t k = 0; k < run->n_left; k++)
        if (is_eligible(run, run->left[k].source))
            run->left[n++] = run->left[k];
    run->n_left = n;
    return true;
}

static void propose_by_table(Run *run)
{
#pragma omp parallel for schedule(dynamic, 64) if (run->n_left > 256)
    for (uint32_t k = 0; k < run->n_left; k++) {
        const Left *left = &run->left[k];
        const FlOffer offer = fl_cost_table_nearest(&run->table, left->row, run->is_free);
        run->target[left->source] = (int32_t)offer.target, run->cost[left->source] = offer.cost;
    }
}

static bool pass(Run *run, Winner *winners, FlNnf *nnf, GError **error)
{
    if (!open_pass(run, error))
        return false;
    for (int sweep = 0; sweep < (run->table.cost ? 1 : run->in->sweeps); sweep++) {
        run->pass_key = fl_key(fl_key(run->in->key, (uint64_t)run->done->passes), (uint64_t)sweep);
        if (run->table.cost)
            propose_by_table(run);
        else
            propose_all(run);
    }
    settle(run, winners, find_winners(run, winners), nnf);
    run->done->passes++;
    return true;
}

static void start(Run *run, const FlNnf *nnf)
{
    memset(run->target, 0xff, run->n_sources * sizeof *run->target);
    memset(run->won, 0xff, (size_t)run->n_sources * run->n_kept * sizeof *run->won);
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const uint32_t target = run->in->targets[j];
        fl_bit_set(run->is_free, target), run->open[j] = target, run->offer[target] = NO_OFFER;
    }
    run->n_open = run->n_free = run->n_targets;
    start_warm(run, nnf);
}

static void count_use(const Run *run)
{
    FlRetrieved *done = run->done;
    done->least = INT32_MAX;
    for (uint32_t c = 0; c < run->n_cells; c++) {
        done->least = MIN(done->least, (int)run->use[c]);
        done->most = MAX(done->most, (int)run->use[c]);
    }
    for (uint32_t c = 0; c < run->n_cells; c++)
        done->n_most += (int)run->use[c] > done->least;
}

bool fl_retrieve(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error)
{
    *done = (FlRetrieved){0};
    if (retrieval->n_targets == 0 || retrieval->n_sources == 0)
        return true;
    if (retrieval->uniform == FL_UNIFORM_OFF)
        return fl_nearest(retrieval, nnf, done, error);
    g_auto(Run) run = {.in = retrieval,
                       .n_turns = retrieval->turns ? TURNS : 1,
                       .n_targets = (uint32_t)retrieval->n_targets,
                       .tile_columns = (retrieval->source.width - 1) / TILE + 1,
                       .done = done};
    run.n_sources = (uint32_t)retrieval->n_sources * run.n_turns;
    run.n_kept = MIN(run.n_targets / run.n_sources + 1, CONTINUED);
    run.n_tiles = run.tile_columns * ((retrieval->source.height - 1) / TILE + 1);
    for (int k = 0; k < TURNS; k++)
        turn_init(&run.turn[k], k, retrieval->source.pitch);
    g_autofree Winner *winners = fl_alloc(run.n_sources, sizeof *winners, "a retrieval", error);
    if (!winners || !alloc_run(&run, error) || !fill_cells(&run, error))
        return false;
    fill_tiles(&run);
    start(&run, nnf);
    while (run.n_free > 0)
        if (!pass(&run, winners, nnf, error))
            return false;
    count_use(&run);
    return true;
}
