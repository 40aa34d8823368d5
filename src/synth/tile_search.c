#include "synth/tile_search.h"

#include "base/rng.h"

/*
 * Where the time goes (perf; a snowman of 19 regions, 1000 px wide, AVX-512): two thirds of a whole
 * render into the search, an eighth into votes, the rest into guides, the drawing's shapes,
 * composing and files. Of the search, four tenths go into patch distances, three into what is
 * below, and a twentieth each into gathering the target's patch, the sieve and the neighbours; in a
 * draft, which searches less, search and votes take a fifth of the render each, the distances of
 * the guides an eighth.
 *
 * A random try's texels are a cache miss each. So pixels go through three stages, each pixel a
 * stage behind the next one of its tile:
 *   draw    draws its tries and has their centres fetched,
 *   sift    keeps those that the segment, the occurrence map and the neighbours do not rule out,
 *           a sixth, and has the rest of their texels fetched,
 *   settle  tests the neighbours' matches and what is left of the tries, both rotations at once.
 * No pixel but itself changes a pixel's match, so the tries may be drawn early.
 */

/* A random try that has not been ruled out. */
typedef struct Candidate {
    const FlTexel *centre;
    FlMatch match;
    uint32_t uniformity;
} Candidate;

/* One pixel being matched. */
typedef struct Visit {
    FlTries tries;
    const FlTileSearch *plan;
    const FlSearch *search;
    int x, y;
    size_t pixel;
    FlSegment segment;
    uint8_t angle;
    FlMatch own; // at the start of the visit: what the occurrence map has counted
    FlCell own_cell;
    FlMatch best;
    uint32_t data;           // fl_match_cost of best
    uint32_t own_uniformity; // the term of `own`
    uint32_t total;          // data with uniformity and coherence
    FlMatch expected[4];     // where the neighbours' matches continue
    int n_expected;
    int n_candidates;
    Candidate candidate[FL_MAX_TRIES];
} Visit;

void fl_tile_search_init(FlTileSearch *plan, const FlSearch *search)
{
    const FlExemplarLevel *level = search->level;
    const FlParams *params = search->params;
    const float side = (float)MAX(level->width, level->height);
    FlWindows *w = &plan->windows;
    plan->search = search;
    *w = (FlWindows){
        .size = {(uint16_t)level->width, (uint16_t)level->height, (uint16_t)level->window},
        .step = {1, (uint32_t)level->pitch, (uint32_t)level->frame_pixels}};
    for (float share = 1; share * side >= 1 && w->n < FL_MAX_TRIES;
         share *= params->patchmatch_alpha, w->n++) {
        w->reach[0][w->n] = (uint16_t)(share * (float)level->width);
        w->reach[1][w->n] = (uint16_t)(share * (float)level->height);
        w->reach[2][w->n] = (uint16_t)(share * (float)level->window + 1);
    }
    for (int n = 0; n <= 4; n++)
        for (int apart = 0; apart <= n; apart++)
            plan->coherence[n][apart] =
                n == 0 ? 0 : (uint32_t)(params->w_coh * search->scale->unit * apart / n);
}

/* Two matches show the same piece of the exemplar: same frame and rotation, within 3/4 px. */
static bool continues(FlMatch a, FlMatch b)
{
    return a.frame == b.frame && abs(a.x_16 - b.x_16) < 12 && abs(a.y_16 - b.y_16) < 12 &&
           fl_angle_distance((uint8_t)(a.theta - b.theta)) < 8;
}

static uint32_t coherence_cost(const Visit *visit, FlMatch candidate)
{
    int apart = 0;
    for (int k = 0; k < visit->n_expected; k++)
        apart += !continues(candidate, visit->expected[k]);
    return visit->plan->coherence[visit->n_expected][apart];
}

static uint32_t uniformity_cost(const Visit *visit, FlMatch candidate)
{
    const FlOccurrence *map = visit->search->map;
    return fl_occurrence_cost(map, visit->segment, fl_occurrence_cell(map, candidate),
                              visit->own_cell);
}

static bool same_match(FlMatch a, FlMatch b)
{
    return a.x_16 == b.x_16 && a.y_16 == b.y_16 && a.frame == b.frame && a.theta == b.theta;
}

/* Left, above, right, below: the scan has just improved the first two or, on odd sweeps, the last
 * two. */
static const int8_t neighbours[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};

static void find_expected(Visit *visit)
{
    const FlNnf *nnf = visit->search->nnf;
    visit->n_expected = 0;
    for (int k = 0; k < 4; k++) {
        const int dx = neighbours[k][0], dy = neighbours[k][1];
        const int nx = visit->x + dx, ny = visit->y + dy;
        if (nx < 0 || ny < 0 || nx >= nnf->width || ny >= nnf->height)
            continue;
        const FlMatch m = nnf->match[(size_t)ny * nnf->width + nx];
        if (m.frame == FL_NO_MATCH)
            continue;
        visit->expected[visit->n_expected++] = fl_match_moved(m, -dx, -dy, visit->search->level);
    }
}

static void draw(Visit *visit, const FlTileSearch *plan, size_t pixel, uint64_t key)
{
    const FlSearch *search = plan->search;
    const FlTexel *first = fl_exemplar_at(search->level, 0, 0, search->level->first);
    visit->plan = plan;
    visit->search = search;
    visit->pixel = pixel;
    visit->x = (int)(pixel % (size_t)search->target->width);
    visit->y = (int)(pixel / (size_t)search->target->width);
    visit->own = visit->best = search->nnf->match[pixel];
    const uint16_t centre[3] = {(uint16_t)fl_match_x(visit->own), (uint16_t)fl_match_y(visit->own),
                                (uint16_t)(visit->own.frame - search->level->first)};
    search->kernels->draw_tries(&plan->windows, centre, (uint32_t)fl_key(key, pixel),
                                &visit->tries);
    for (int k = 0; k < plan->windows.n; k++)
        __builtin_prefetch(first + visit->tries.pixel[k]);
}

static FlSieve sieve_of(const Visit *visit)
{
    const FlSearch *search = visit->search;
    const FlOccurrence *map = search->map;
    const uint32_t apart = visit->plan->coherence[visit->n_expected][visit->n_expected];
    FlSieve sieve = {
        .first = fl_exemplar_at(search->level, 0, 0, search->level->first),
        .segment = (uint8_t)visit->segment,
        .use = map->filtered[visit->segment],
        .step = {1, (uint32_t)map->columns, (uint32_t)map->columns * (uint32_t)map->rows},
        .factor = {FL_CELL_FACTOR, FL_CELL_FACTOR, map->slice_factor},
        .own = {(uint16_t)visit->own_cell.x, (uint16_t)visit->own_cell.y,
                (uint16_t)visit->own_cell.t},
        .price = map->price[visit->segment],
        .most = FL_OCCURRENCE_MOST,
        .limit = visit->total > apart ? visit->total - apart : 0};
    for (int k = 0; k < 4; k++)
        sieve.frames[k] = k < visit->n_expected
                              ? (int16_t)(visit->expected[k].frame - search->level->first)
                              : FL_NO_MATCH;
    return sieve;
}

static void add_candidate(Visit *visit, int k, uint32_t uniformity)
{
    const FlExemplarLevel *level = visit->search->level;
    const FlTries *tries = &visit->tries;
    Candidate *c = &visit->candidate[visit->n_candidates++];
    c->match = (FlMatch){.x_16 = (uint16_t)(16 * tries->at[0][k]),
                         .y_16 = (uint16_t)(16 * tries->at[1][k]),
                         .frame = (int16_t)(level->first + tries->at[2][k])};
    c->uniformity = uniformity;
    c->centre = fl_exemplar_at(level, 0, 0, level->first) + tries->pixel[k];
    if (visit->search->params->rotate)
        c->match.theta = (uint8_t)(visit->angle - c->centre->c[FL_CH_ANGLE]);
    const int16_t *offsets = level->offsets[c->match.theta];
    for (int p = 0; p < 8; p++) // the outer ring: the lines between are mostly the same
        __builtin_prefetch(c->centre + offsets[p]);
}

static void sift(Visit *visit)
{
    const FlSearch *search = visit->search;
    visit->angle = search->target->angle[visit->pixel];
    visit->segment = search->target->segment[visit->pixel];
    visit->own_cell = fl_occurrence_cell(search->map, visit->own);
    visit->data = search->cost[visit->pixel];
    visit->own_uniformity = uniformity_cost(visit, visit->own);
    find_expected(visit);
    visit->total = visit->data + visit->own_uniformity + coherence_cost(visit, visit->own);
    const FlSieve sieve = sieve_of(visit);
    uint32_t uniformity[FL_MAX_TRIES];
    visit->n_candidates = 0;
    for (uint64_t left =
             search->kernels->sift(&visit->tries, visit->plan->windows.n, &sieve, uniformity);
         left; left &= left - 1) {
        const int k = __builtin_ctzll(left);
        add_candidate(visit, k, uniformity[k]);
    }
}

static void take(Visit *visit, FlMatch match, uint32_t prior, uint32_t data)
{
    if (prior >= visit->total || data >= visit->total - prior)
        return;
    visit->best = match;
    visit->data = data;
    visit->total = data + prior;
}

/* Returns: how many distances were started. */
static int try_match(Visit *visit, const FlTargetPatch *patch, FlMatch match, const FlTexel *centre,
                     uint32_t uniformity)
{
    const uint32_t prior = uniformity + coherence_cost(visit, match);
    if (prior >= visit->total || same_match(match, visit->best))
        return 0;
    take(visit, match, prior,
         fl_patch_cost(visit->search, patch, visit->angle, centre, match.theta,
                       visit->total - prior - 1));
    return 1;
}

/* Both rotations of a try [P21 §4.3]; their directions are the target's and cost nothing. */
static int try_both(Visit *visit, const FlTargetPatch *patch, const Candidate *c)
{
    const FlSearch *search = visit->search;
    FlMatch turned = c->match;
    turned.theta += 128;
    const uint32_t prior[2] = {c->uniformity + coherence_cost(visit, c->match),
                               c->uniformity + coherence_cost(visit, turned)};
    const uint32_t total = visit->total, lower = MIN(prior[0], prior[1]);
    if (lower >= total)
        return 0;
    uint32_t data[2];
    search->kernels->patch_pair(c->centre, search->level->offsets[c->match.theta], patch->guide,
                                &search->target->rest, total - lower - 1, data);
    take(visit, c->match, prior[0], data[0]);
    take(visit, turned, prior[1], data[1]);
    return (prior[0] < total) + (prior[1] < total);
}

static int propagate(Visit *visit, const FlTargetPatch *patch)
{
    const FlExemplarLevel *level = visit->search->level;
    int tried = 0;
    for (int k = 0; k < visit->n_expected; k++) {
        const FlMatch m = visit->expected[k];
        if (m.frame == FL_NO_MATCH || same_match(m, visit->own))
            continue;
        const FlTexel *centre = fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame);
        if (centre->c[FL_CH_SEGMENT] == visit->segment)
            tried += try_match(visit, patch, m, centre, uniformity_cost(visit, m));
    }
    return tried;
}

static void settle(Visit *visit, FlSearchCounts *counts)
{
    const FlSearch *search = visit->search;
    FlTargetPatch patch;
    fl_target_gather(search->target, visit->x, visit->y, &patch);
    find_expected(visit); // the pixel before may have moved
    visit->total = visit->data + visit->own_uniformity + coherence_cost(visit, visit->own);
    counts->drawn += (uint64_t)visit->n_expected;
    counts->tried += propagate(visit, &patch);
    for (int k = 0; k < visit->n_candidates; k++) {
        const Candidate *c = &visit->candidate[k];
        counts->tried += search->params->rotate
                             ? try_both(visit, &patch, c)
                             : try_match(visit, &patch, c->match, c->centre, c->uniformity);
    }
    if (same_match(visit->own, visit->best))
        return;
    counts->accepted++;
    fl_occurrence_move(search->map, visit->segment, visit->own, visit->best);
    search->nnf->match[visit->pixel] = visit->best;
    search->cost[visit->pixel] = visit->data;
}

/* Lists a tile's pixels in the order of the scan. Returns their number. */
static int list_pixels(const FlTargetLevel *target, uint32_t tile, bool backwards, size_t *pixels)
{
    const int x0 = (int)(tile % target->tile_columns) * FL_TILE;
    const int y0 = (int)(tile / target->tile_columns) * FL_TILE;
    int n = 0;
    for (int k = 0; k < FL_TILE * FL_TILE; k++) {
        const int at = backwards ? FL_TILE * FL_TILE - 1 - k : k;
        const int x = x0 + at % FL_TILE, y = y0 + at / FL_TILE;
        const size_t p = (size_t)y * target->width + x;
        if (x < target->width && y < target->height && target->segment[p] != FL_SEGMENT_OUTSIDE)
            pixels[n++] = p;
    }
    return n;
}

void fl_tile_search_run(const FlTileSearch *plan, const uint32_t *tiles, int n, bool backwards,
                        uint64_t key, FlSearchCounts *counts)
{
    size_t pixels[FL_TILES_AT_ONCE * FL_TILE * FL_TILE];
    Visit visits[3];
    int end = 0;
    for (int k = 0; k < n; k++)
        end += list_pixels(plan->search->target, tiles[k], backwards, pixels + end);
    counts->drawn += (uint64_t)end * plan->windows.n * (plan->search->params->rotate ? 2 : 1);
    for (int k = 0; k < end + 2; k++) {
        if (k < end)
            draw(&visits[k % 3], plan, pixels[k], key);
        if (k >= 1 && k <= end)
            sift(&visits[(k - 1) % 3]);
        if (k >= 2)
            settle(&visits[(k - 2) % 3], counts);
    }
}
