#include "lazy/retrieval_run.h"

#include "base/alloc.h"
#include "base/bits.h"
#include <string.h>

#define TILE 16 // side of a tile of source pixels; they are searched as a chequerboard

const int8_t fl_retrieval_steps[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};

void fl_retrieval_run_clear(FlRetrievalRun *run)
{
    void *const arrays[] = {
        run->place_at,   run->target,  run->cost, run->won,   run->warm,  run->warm_first,
        run->warm_end,   run->is_free, run->open, run->offer, run->cell,  run->tile_places,
        run->tile_first, run->use,     run->left, run->table, run->column};
    for (size_t k = 0; k < G_N_ELEMENTS(arrays); k++)
        free(arrays[k]);
}

static void turn_init(FlSourceTurn *turn, int quarters, ptrdiff_t pitch)
{
    const uint8_t theta = (uint8_t)(quarters * FL_ANGLES / FL_RETRIEVAL_TURNS);
    int x, y;
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        fl_unrotate(theta, k % FL_PATCH - FL_PATCH_RADIUS, k / FL_PATCH - FL_PATCH_RADIUS, &x, &y);
        turn->offset[k] = (int32_t)(y / 16 * pitch + x / 16);
    }
    for (int k = 0; k < 4; k++) {
        fl_unrotate(theta, fl_retrieval_steps[k][0], fl_retrieval_steps[k][1], &x, &y);
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

static bool alloc_run(FlRetrievalRun *run, GError **error)
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

/* Sorts the places into tiles; in a tile they keep their order. */
static void fill_tiles(FlRetrievalRun *run)
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
static uint32_t block_side(const FlRetrievalRun *run)
{
    uint32_t side = 1;
    const bool blocks = run->in->uniform == FL_UNIFORM_BLOCK ||
                        (run->in->uniform == FL_UNIFORM_AUTO && run->n_sources > run->n_targets);
    while (blocks && run->n_sources / (side * side) > run->n_targets)
        side++;
    return side;
}

/* Assigns the sources to cells (patches or blocks) and sets the quota of a cell. */
static bool fill_cells(FlRetrievalRun *run, GError **error)
{
    const uint32_t side = block_side(run), width = (uint32_t)run->in->source.width;
    const uint32_t columns = width / side + 1;
    const size_t n = (size_t)columns * ((uint32_t)run->in->source.height / side + 1) * run->n_turns;
    g_autofree uint32_t *number = fl_alloc(side > 1 ? n : 1, sizeof *number, "a retrieval", error);
    if (!number)
        return false;
    for (uint32_t s = 0; s < run->n_sources; s++) {
        const uint32_t p = fl_retrieval_pixel(run, s), row = p / width / side,
                       column = p % width / side;
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

/* The source of a match, as a number; FL_NO_TARGET. */
static int32_t source_of(const FlRetrievalRun *run, FlMatch m)
{
    const int x = fl_match_x(m), y = fl_match_y(m), quarter = FL_ANGLES / FL_RETRIEVAL_TURNS;
    if (m.frame == FL_NO_MATCH || x >= run->in->source.width || y >= run->in->source.height)
        return FL_NO_TARGET;
    const int32_t place = run->place_at[(size_t)y * (size_t)run->in->source.width + (size_t)x];
    const uint32_t turn = (uint32_t)(m.theta + quarter / 2) / (uint32_t)quarter % run->n_turns;
    return place < 0 ? FL_NO_TARGET : (int32_t)((uint32_t)place * run->n_turns + turn);
}

/* Sorts the targets of the warm start by source; of one they stand in their order. */
static void start_warm(FlRetrievalRun *run, const FlNnf *nnf)
{
    uint32_t n = 0;
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const int32_t s = source_of(run, nnf->match[run->in->targets[j]]);
        if (s != FL_NO_TARGET)
            run->warm_end[s]++;
    }
    for (uint32_t s = 0; s < run->n_sources; s++) {
        run->warm_first[s] = n;
        n += run->warm_end[s], run->warm_end[s] = run->warm_first[s];
    }
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const int32_t s = source_of(run, nnf->match[run->in->targets[j]]);
        if (s != FL_NO_TARGET)
            run->warm[run->warm_end[s]++] = run->in->targets[j];
    }
}

static void start(FlRetrievalRun *run, const FlNnf *nnf)
{
    memset(run->target, 0xff, run->n_sources * sizeof *run->target);
    memset(run->won, 0xff, (size_t)run->n_sources * run->n_kept * sizeof *run->won);
    for (uint32_t j = 0; j < run->n_targets; j++) {
        const uint32_t target = run->in->targets[j];
        fl_bit_set(run->is_free, target), run->open[j] = target, run->offer[target] = FL_NO_OFFER;
    }
    run->n_open = run->n_free = run->n_targets;
    start_warm(run, nnf);
}

bool fl_retrieval_run_init(FlRetrievalRun *run, const FlRetrieval *retrieval, const FlNnf *nnf,
                           FlRetrieved *done, GError **error)
{
    *run = (FlRetrievalRun){.in = retrieval,
                            .n_turns = retrieval->turns ? FL_RETRIEVAL_TURNS : 1,
                            .n_targets = (uint32_t)retrieval->n_targets,
                            .tile_columns = (retrieval->source.width - 1) / TILE + 1,
                            .done = done};
    run->n_sources = (uint32_t)retrieval->n_sources * run->n_turns;
    run->n_kept = MIN(run->n_targets / run->n_sources + 1, FL_RETRIEVAL_KEPT);
    run->n_tiles = run->tile_columns * ((retrieval->source.height - 1) / TILE + 1);
    for (int k = 0; k < FL_RETRIEVAL_TURNS; k++)
        turn_init(&run->turn[k], k, retrieval->source.pitch);
    if (!alloc_run(run, error) || !fill_cells(run, error))
        return false;
    fill_tiles(run);
    start(run, nnf);
    return true;
}
