#include "lazy/retrieval_run.h"

#include "base/alloc.h"
#include "base/rng.h"

#define TILE 16 // side of a tile of targets; they are searched as a chequerboard

typedef struct Search {
    const FlRetrieval *in;
    uint8_t *is_source, *is_target; // by pixel
    uint32_t *cost;                 // by pixel of the target
    FlNnf *nnf;
    uint64_t key; // of the sweep
    bool backwards;
} Search;

static void search_clear(Search *search)
{
    free(search->is_source);
    free(search->is_target);
    free(search->cost);
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(Search, search_clear)

static uint8_t *marks(const FlFluidPicture *picture, const uint32_t *places, size_t n,
                      GError **error)
{
    uint8_t *at = fl_alloc((size_t)picture->width * (size_t)picture->height, 1, "a search", error);
    for (size_t k = 0; at && k < n; k++)
        at[places[k]] = 1;
    return at;
}

static uint32_t cost_of(const Search *search, uint32_t pixel, FlMatch m, uint32_t limit)
{
    _Alignas(32) FlFluidTexel patch[FL_PATCH_PIXELS];
    const FlFluidPicture *source = &search->in->source, *target = &search->in->target;
    const FlFluidTexel *middle = source->pixel + fl_match_y(m) * source->pitch + fl_match_x(m);
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        int x, y;
        fl_unrotate(m.theta, k % FL_PATCH - FL_PATCH_RADIUS, k / FL_PATCH - FL_PATCH_RADIUS, &x,
                    &y);
        patch[k] = middle[y / 16 * source->pitch + x / 16];
    }
    const uint32_t width = (uint32_t)target->width;
    const ptrdiff_t tx = pixel % width, ty = pixel / width;
    return search->in->distance(
        patch, target->pixel + (ty - FL_PATCH_RADIUS) * target->pitch + tx - FL_PATCH_RADIUS,
        target->pitch, limit);
}

static bool is_valid(const Search *search, int x, int y)
{
    const int width = search->in->source.width, height = search->in->source.height;
    return x >= 0 && y >= 0 && x < width && y < height &&
           search->is_source[(size_t)y * (size_t)width + (size_t)x];
}

static void try_match(Search *search, uint32_t pixel, FlMatch m)
{
    if (m.frame == FL_NO_MATCH || !is_valid(search, fl_match_x(m), fl_match_y(m)))
        return;
    const uint32_t cost = cost_of(search, pixel, m, search->cost[pixel]);
    if (cost < search->cost[pixel])
        search->cost[pixel] = cost, search->nnf->match[pixel] = m;
}

static FlMatch match_at(int x, int y, uint32_t quarters)
{
    return (FlMatch){.x_16 = (uint16_t)(16 * x),
                     .y_16 = (uint16_t)(16 * y),
                     .theta = (uint8_t)(quarters * (FL_ANGLES / 4))};
}

static FlMatch random_match(const Search *search, FlRng *rng)
{
    const uint32_t width = (uint32_t)search->in->source.width;
    const uint32_t p = search->in->sources[fl_rng_below(rng, (uint32_t)search->in->n_sources)];
    return match_at((int)(p % width), (int)(p / width),
                    search->in->turns ? fl_rng_below(rng, 4) : 0);
}

static void try_beside(Search *search, uint32_t pixel, int dx, int dy)
{
    const int width = search->in->target.width, height = search->in->target.height;
    const int x = (int)pixel % width + dx, y = (int)pixel / width + dy;
    if (x < 0 || y < 0 || x >= width || y >= height ||
        !search->is_target[(size_t)y * (size_t)width + (size_t)x])
        return;
    FlMatch m = search->nnf->match[(size_t)y * (size_t)width + (size_t)x];
    int sx, sy;
    fl_unrotate(m.theta, -dx, -dy, &sx, &sy);
    const int at_x = fl_match_x(m) + sx / 16, at_y = fl_match_y(m) + sy / 16;
    if (m.frame != FL_NO_MATCH && at_x >= 0 && at_y >= 0)
        try_match(search, pixel, match_at(at_x, at_y, m.theta / (FL_ANGLES / 4)));
}

static void improve(Search *search, uint32_t pixel)
{
    static const int8_t steps[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};
    FlRng rng = {fl_key(search->key, pixel)};
    const int side = MAX(search->in->source.width, search->in->source.height);
    for (int k = 0; k < 4; k++)
        try_beside(search, pixel, steps[k][0], steps[k][1]);
    for (int reach = side / 2; reach >= 1; reach /= 2) {
        const FlMatch m = search->nnf->match[pixel];
        const uint32_t width = 2 * (uint32_t)reach + 1;
        const int x = fl_match_x(m) - reach + (int)fl_rng_below(&rng, width);
        const int y = fl_match_y(m) - reach + (int)fl_rng_below(&rng, width);
        const uint32_t turn = search->in->turns ? fl_rng_below(&rng, 4) : 0;
        if (is_valid(search, x, y))
            try_match(search, pixel, match_at(x, y, turn));
    }
}

static void improve_tile(Search *search, int column, int row)
{
    const int width = search->in->target.width, height = search->in->target.height;
    for (int k = 0; k < TILE * TILE; k++) {
        const int at = search->backwards ? TILE * TILE - 1 - k : k;
        const int x = column * TILE + at % TILE, y = row * TILE + at / TILE;
        const size_t pixel = (size_t)y * (size_t)width + (size_t)x;
        if (x < width && y < height && search->is_target[pixel])
            improve(search, (uint32_t)pixel);
    }
}

static void sweep(Search *search)
{
    const int columns = (search->in->target.width - 1) / TILE + 1;
    const int n = columns * ((search->in->target.height - 1) / TILE + 1);
    for (int colour = 0; colour < 2; colour++) {
#pragma omp parallel for schedule(dynamic, 1)
        for (int tile = 0; tile < n; tile++)
            if (((tile % columns + tile / columns) & 1) == colour)
                improve_tile(search, tile % columns, tile / columns);
    }
}

bool fl_nearest(const FlRetrieval *retrieval, FlNnf *nnf, FlRetrieved *done, GError **error)
{
    const size_t pixels = (size_t)retrieval->target.width * (size_t)retrieval->target.height;
    g_auto(Search) search = {.in = retrieval, .nnf = nnf};
    if (!(search.is_source =
              marks(&retrieval->source, retrieval->sources, retrieval->n_sources, error)) ||
        !(search.is_target =
              marks(&retrieval->target, retrieval->targets, retrieval->n_targets, error)) ||
        !(search.cost = fl_alloc(pixels, sizeof *search.cost, "a search", error)))
        return false;
    for (size_t k = 0; k < retrieval->n_targets; k++) {
        const uint32_t pixel = retrieval->targets[k];
        FlRng rng = {fl_key(retrieval->key, pixel)};
        FlMatch m = nnf->match[pixel];
        if (m.frame == FL_NO_MATCH || !is_valid(&search, fl_match_x(m), fl_match_y(m)))
            m = random_match(&search, &rng);
        m = match_at(fl_match_x(m), fl_match_y(m), m.theta / (FL_ANGLES / 4));
        nnf->match[pixel] = m;
        search.cost[pixel] = cost_of(&search, pixel, m, UINT32_MAX);
    }
    for (int k = 0; k < 2 * retrieval->sweeps; k++) {
        search.key = fl_key(retrieval->key, 1 + (uint64_t)k);
        search.backwards = k & 1;
        sweep(&search);
    }
    for (size_t k = 0; k < retrieval->n_targets; k++)
        done->energy +=
            (double)search.cost[retrieval->targets[k]] / ((double)FL_FLUID_ONE * FL_FLUID_ONE);
    return true;
}
