#include "lazy/retrieve.h"

#include "base/alloc.h"
#include "base/bits.h"
#include "base/rng.h"
#include "lazy/retrieval_run.h"
#include <string.h>

#define TABLE (1u << 18) // with as many pairs at most, all distances are known
#define FEW_TARGETS 32   // free ones: all distances to them are known,
#define FEW_SHARE 100    // as where they are a share of all,
#define FEW_PAIRS 3      // unless there are more pairs than so many a target

/* ---- targets choose -------------------------------------------------------------------------- */

/* A source that has won its target; the key is the cost and a hash that settles ties. */
typedef struct Winner {
    uint64_t key;
    uint32_t source, cell;
} Winner;

static uint64_t offer_key(const FlRetrievalRun *run, uint32_t source)
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

static void assign(FlRetrievalRun *run, const Winner *winner, FlNnf *nnf)
{
    const uint32_t s = winner->source, pixel = fl_retrieval_pixel(run, s);
    const int32_t target = run->target[s];
    const uint32_t width = (uint32_t)run->in->source.width;
    nnf->match[target] =
        (FlMatch){.x_16 = (uint16_t)(16 * (pixel % width)),
                  .y_16 = (uint16_t)(16 * (pixel / width)),
                  .theta = (uint8_t)(s % run->n_turns * (FL_ANGLES / FL_RETRIEVAL_TURNS))};
    fl_bit_clear(run->is_free, (uint32_t)target);
    run->n_free--;
    run->use[winner->cell]++;
    int32_t *won = run->won + (size_t)s * run->n_kept;
    memmove(won + 1, won, (run->n_kept - 1) * sizeof *won);
    won[0] = target;
    run->done->energy += (double)(winner->key >> 32) / ((double)FL_FLUID_ONE * FL_FLUID_ONE);
}

/* Every target's best offer; then the sources whose offer it is. */
static uint32_t find_winners(FlRetrievalRun *run, Winner *winners)
{
    const bool few = run->table;
    const uint32_t sources = few ? run->n_left : run->n_sources;
    uint32_t n = 0;
    for (uint32_t k = 0; k < sources; k++) {
        const uint32_t s = few ? run->left[k].source : k;
        if (run->target[s] != FL_NO_TARGET)
            run->offer[run->target[s]] = MIN(run->offer[run->target[s]], offer_key(run, s));
    }
    for (uint32_t k = 0; k < sources; k++) {
        const uint32_t s = few ? run->left[k].source : k;
        if (run->target[s] != FL_NO_TARGET && run->offer[run->target[s]] == offer_key(run, s))
            winners[n++] = (Winner){offer_key(run, s), s, run->cell[s]};
    }
    for (uint32_t k = 0; k < n; k++)
        run->offer[run->target[winners[k].source]] = FL_NO_OFFER;
    return n;
}

/* Assigns those whose cells have room up to K, then the nearest of those that may go beyond. */
static void settle(FlRetrievalRun *run, Winner *winners, uint32_t n, FlNnf *nnf)
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
static void compact_open(FlRetrievalRun *run)
{
    uint32_t n = 0;
    if (run->n_free > run->n_open - run->n_open / 8)
        return;
    for (uint32_t k = 0; k < run->n_open; k++)
        if (fl_bit(run->is_free, run->open[k]))
            run->open[n++] = run->open[k];
    run->n_open = n;
}

static void fill_row(FlRetrievalRun *run, uint32_t row)
{
    _Alignas(32) FlFluidTexel patch[FL_PATCH_PIXELS];
    const FlFluidPicture *picture = &run->in->target;
    fl_retrieval_gather(run, run->left[row].source, patch);
    for (uint32_t j = 0; j < run->n_columns; j++)
        run->table[(size_t)row * run->n_columns + j] = run->in->distance(
            patch, fl_retrieval_patch(picture, run->column[j]), picture->pitch, UINT32_MAX);
}

/* All distances between the sources and the targets that are left. */
static bool make_table(FlRetrievalRun *run, uint32_t n_eligible, GError **error)
{
    uint32_t n = 0;
    if (!(run->left = fl_alloc(n_eligible, sizeof *run->left, "distances", error)) ||
        !(run->column = fl_alloc(run->n_free, sizeof *run->column, "distances", error)) ||
        !(run->table = fl_alloc_scratch((size_t)n_eligible * run->n_free, sizeof *run->table,
                                        "distances", error)))
        return false;
    run->n_columns = run->n_free;
    for (uint32_t s = 0; s < run->n_sources; s++)
        if (fl_retrieval_is_eligible(run, s)) {
            run->left[run->n_left] = (FlSourceLeft){s, run->n_left};
            run->n_left++;
        }
    for (uint32_t k = 0; k < run->n_open; k++)
        if (fl_bit(run->is_free, run->open[k]))
            run->column[n++] = run->open[k];
#pragma omp parallel for schedule(dynamic, 16) if (run->n_left > 64)
    for (uint32_t row = 0; row < run->n_left; row++)
        fill_row(run, row);
    run->done->evaluations += (uint64_t)run->n_left * run->n_free;
    return true;
}

/* Returns: true if few enough pairs are left for a table. */
static bool are_few(const FlRetrievalRun *run, uint32_t n_eligible)
{
    const uint64_t pairs = (uint64_t)n_eligible * run->n_free;
    const bool few = run->n_free < MAX(FEW_TARGETS, run->n_targets / FEW_SHARE);
    return (uint64_t)run->n_sources * run->n_targets <= TABLE ||
           (few && pairs <= FEW_PAIRS * (uint64_t)run->n_targets);
}

static bool open_pass(FlRetrievalRun *run, GError **error)
{
    uint32_t n = 0;
    run->backwards = run->done->passes & 1;
    if (!run->table) {
        for (uint32_t s = 0; s < run->n_sources; s++)
            n += fl_retrieval_is_eligible(run, s);
        compact_open(run);
        return !are_few(run, n) || make_table(run, n, error);
    }
    for (uint32_t k = 0; k < run->n_left; k++)
        if (fl_retrieval_is_eligible(run, run->left[k].source))
            run->left[n++] = run->left[k];
    run->n_left = n;
    return true;
}

/* Proposes to the free target that is nearest to a source, of equals to one by hash. */
static void propose_nearest(FlRetrievalRun *run, FlSourceLeft left)
{
    const uint32_t *cost = run->table + (size_t)left.row * run->n_columns;
    const uint32_t key = (uint32_t)run->in->key ^ fl_hash32(left.row);
    int32_t best = FL_NO_TARGET;
    uint32_t least = UINT32_MAX;
    for (uint32_t k = 0; k < run->n_columns; k++) {
        const uint32_t target = run->column[k];
        if (cost[k] > least || !fl_bit(run->is_free, target))
            continue;
        if (best == FL_NO_TARGET || cost[k] < least ||
            fl_hash32(target ^ key) < fl_hash32((uint32_t)best ^ key))
            best = (int32_t)target, least = cost[k];
    }
    run->target[left.source] = best, run->cost[left.source] = least;
}

static void propose_by_table(FlRetrievalRun *run)
{
#pragma omp parallel for schedule(dynamic, 64) if (run->n_left > 256)
    for (uint32_t k = 0; k < run->n_left; k++)
        propose_nearest(run, run->left[k]);
}

static bool pass(FlRetrievalRun *run, Winner *winners, FlNnf *nnf, GError **error)
{
    if (!open_pass(run, error))
        return false;
    for (int sweep = 0; sweep < (run->table ? 1 : run->in->sweeps); sweep++) {
        run->pass_key = fl_key(fl_key(run->in->key, (uint64_t)run->done->passes), (uint64_t)sweep);
        if (run->table)
            propose_by_table(run);
        else
            fl_propose_all(run);
    }
    settle(run, winners, find_winners(run, winners), nnf);
    run->done->passes++;
    return true;
}

static void count_use(const FlRetrievalRun *run)
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
    g_auto(FlRetrievalRun) run = {0};
    if (!fl_retrieval_run_init(&run, retrieval, nnf, done, error))
        return false;
    g_autofree Winner *winners = fl_alloc(run.n_sources, sizeof *winners, "a retrieval", error);
    if (!winners)
        return false;
    while (run.n_free > 0)
        if (!pass(&run, winners, nnf, error))
            return false;
    count_use(&run);
    return true;
}
