#include "synth/tile_search.h"

#include "base/rng.h"

/*
 * Time (perf; a snowman of 19 regions, 1000 px wide, AVX-512): the search takes nearly half of a
 * whole render, votes an eighth; guides, shapes of the drawing, compositing and files the rest. Of
 * the search, patch distances take a third, this file two fifths, the occurrence map a tenth. A
 * draft searches less: the search takes an eighth of the render, votes a fifteenth.
 *
 * Each texel of a random candidate is a cache miss. So pixels go through three stages, each a stage
 * ahead of the next pixel of its tile:
 *   draw    draws the candidates and prefetches their centres,
 *   filter  keeps those that segment, occurrence map and neighbours do not rule out, a sixth, and
 *           prefetches the rest of their texels,
 *   settle  tests the neighbours' matches and the kept candidates, both rotations at once.
 * Only a pixel itself changes its match, so its candidates may be drawn early.
 */

/* A random candidate that filter_candidates() kept. */
typedef struct KeptCandidate {
    const FlTexel *centre;
    FlMatch match;
    uint32_t uniformity;
} KeptCandidate;

typedef struct Place {
    uint16_t x, y;
} Place;

/* The search for the match of one pixel. */
typedef struct PixelSearch {
    FlCandidates candidates;
    const FlTileSearch *tile_search;
    const FlSearch *search;
    const FlSearchWindows *windows; // windows of random candidates; NULL: no windows
    int x, y, sweep;
    size_t pixel;
    FlSegment segment;
    uint8_t angle;
    FlMatch own; // at the start: the match that the occurrence map counts
    FlCell own_cell;
    FlMatch best;
    uint32_t data;                   // fl_match_cost of best
    uint32_t own_uniformity;         // the term of `own`
    uint32_t total;                  // data with uniformity and coherence
    FlMatch expected[FL_NEIGHBOURS]; // matches that continue the neighbours'
    int n_expected;
    FlMatch carried;  // the match that the drawing's motion took here
    uint32_t leaving; // cost of a match that does not continue `carried`
    int n_kept;
    KeptCandidate kept[FL_MAX_CANDIDATES];
} PixelSearch;

/* Those of the windows that reach no farther than `most` px. */
static FlSearchWindows windows_near(const FlSearchWindows *windows, int most)
{
    FlSearchWindows near = *windows;
    near.n = 0;
    for (int k = 0; k < windows->n; k++) {
        if (MAX(windows->reach[0][k], windows->reach[1][k]) > most)
            continue;
        for (int i = 0; i < 3; i++)
            near.reach[i][near.n] = windows->reach[i][k];
        near.n++;
    }
    return near;
}

void fl_tile_search_init(FlTileSearch *tile_search, const FlSearch *search)
{
    const FlExemplarLevel *level = search->level;
    const FlParams *params = search->params;
    const float side = (float)MAX(level->width, level->height);
    FlSearchWindows *w = &tile_search->windows;
    tile_search->search = search;
    *w = (FlSearchWindows){
        .size = {(uint16_t)level->width, (uint16_t)level->height, (uint16_t)level->window},
        .step = {1, (uint32_t)level->pitch, (uint32_t)level->frame_pixels}};
    for (float share = 1; share * side >= 1 && w->n < FL_MAX_CANDIDATES;
         share *= params->patchmatch_alpha, w->n++) {
        w->reach[0][w->n] = (uint16_t)(share * (float)level->width);
        w->reach[1][w->n] = (uint16_t)(share * (float)level->height);
        w->reach[2][w->n] = (uint16_t)(share * (float)level->window + 1);
    }
    tile_search->near = windows_near(w, search->near_px);
    for (int n = 0; n <= 4; n++)
        for (int apart = 0; apart <= n; apart++)
            tile_search->coherence[n][apart] =
                n == 0 ? 0 : (uint32_t)(search->w_coh * search->scale->unit * apart / n);
}

/* Coherence in space, and in time where the drawing carries the paint. */
static uint32_t coherence_cost(const PixelSearch *ps, FlMatch candidate)
{
    int apart = 0;
    for (int k = 0; k < ps->n_expected; k++)
        apart += !fl_match_continues(candidate, ps->expected[k]);
    const bool leaves = ps->leaving > 0 && !fl_match_continues(candidate, ps->carried);
    return ps->tile_search->coherence[ps->n_expected][apart] + (leaves ? ps->leaving : 0);
}

/* The coherence cost of a match that continues no other match. */
static uint32_t coherence_apart(const PixelSearch *ps)
{
    return ps->tile_search->coherence[ps->n_expected][ps->n_expected] + ps->leaving;
}

static void find_carried(PixelSearch *ps)
{
    const FlSearch *search = ps->search;
    ps->leaving = fl_leaving_cost(search, ps->pixel);
    if (ps->leaving > 0)
        ps->carried = search->carried->match[ps->pixel];
}

static uint32_t uniformity_cost(const PixelSearch *ps, FlMatch candidate)
{
    const FlOccurrence *map = ps->search->map;
    return fl_occurrence_cost(map, ps->segment, fl_occurrence_cell(map, candidate), ps->own_cell);
}

static bool same_match(FlMatch a, FlMatch b)
{
    return a.x_16 == b.x_16 && a.y_16 == b.y_16 && a.frame == b.frame && a.theta == b.theta;
}

static void find_expected(PixelSearch *ps)
{
    ps->n_expected = fl_matches_beside(ps->search, ps->x, ps->y, ps->expected);
}

/* The windows of a pixel's candidates. */
static const FlSearchWindows *windows_for(const FlTileSearch *tile_search, size_t pixel, int sweep)
{
    const FlSearch *search = tile_search->search;
    if (search->propagate_from > 0 && sweep >= search->propagate_from)
        return NULL;
    if (search->cost[pixel] >= search->settled)
        return &tile_search->windows;
    return sweep == 0 && tile_search->near.n > 0 ? &tile_search->near : NULL;
}

static void draw(PixelSearch *ps, const FlTileSearch *tile_search, Place place, int sweep)
{
    const FlSearch *search = tile_search->search;
    const FlTexel *first = fl_exemplar_at(search->level, 0, 0, search->level->first);
    const size_t pixel = (size_t)place.y * search->target->width + place.x;
    ps->tile_search = tile_search;
    ps->search = search;
    ps->pixel = pixel;
    ps->x = place.x;
    ps->y = place.y;
    ps->sweep = sweep;
    ps->own = ps->best = search->nnf->match[pixel];
    ps->windows = windows_for(tile_search, pixel, sweep);
    if (!ps->windows)
        return;
    const uint64_t key = fl_key(search->key, (uint64_t)sweep);
    const uint16_t centre[3] = {(uint16_t)fl_match_x(ps->own), (uint16_t)fl_match_y(ps->own),
                                (uint16_t)(ps->own.frame - search->level->first)};
    fl_draw_candidates(ps->windows, centre, (uint32_t)fl_key(key, pixel), &ps->candidates);
    for (int k = 0; k < ps->windows->n; k++)
        __builtin_prefetch(first + ps->candidates.pixel[k]);
}

static FlCandidateFilter filter_of(const PixelSearch *ps)
{
    const FlSearch *search = ps->search;
    const FlOccurrence *map = search->map;
    const uint32_t apart = coherence_apart(ps);
    FlCandidateFilter filter = {
        .first = fl_exemplar_at(search->level, 0, 0, search->level->first),
        .segment = (uint8_t)ps->segment,
        .use = map->filtered[ps->segment],
        .step = {1, (uint32_t)map->columns, (uint32_t)map->columns * (uint32_t)map->rows},
        .factor = {FL_CELL_FACTOR, FL_CELL_FACTOR, map->slice_factor},
        .own = {(uint16_t)ps->own_cell.x, (uint16_t)ps->own_cell.y, (uint16_t)ps->own_cell.t},
        .price = map->price[ps->segment],
        .most = FL_OCCURRENCE_MOST,
        .limit = ps->total > apart ? ps->total - apart : 0};
    for (int k = 0; k < 4; k++)
        filter.frames[k] = k < ps->n_expected
                               ? (int16_t)(ps->expected[k].frame - search->level->first)
                               : FL_NO_MATCH;
    return filter;
}

static void keep_candidate(PixelSearch *ps, int k, uint32_t uniformity)
{
    const FlExemplarLevel *level = ps->search->level;
    const FlCandidates *candidates = &ps->candidates;
    KeptCandidate *c = &ps->kept[ps->n_kept++];
    c->match = (FlMatch){.x_16 = (uint16_t)(16 * candidates->at[0][k]),
                         .y_16 = (uint16_t)(16 * candidates->at[1][k]),
                         .frame = (int16_t)(level->first + candidates->at[2][k])};
    c->uniformity = uniformity;
    c->centre = fl_exemplar_at(level, 0, 0, level->first) + candidates->pixel[k];
    if (ps->search->params->rotate)
        c->match.theta = (uint8_t)(ps->angle - c->centre->c[FL_CH_ANGLE]);
    const int16_t *offsets = level->offsets[c->match.theta];
    for (int p = 0; p < 8; p++) // the outer ring: the lines between are mostly the same
        __builtin_prefetch(c->centre + offsets[p]);
}

/* Looks up the pixel's own data, without the matches that its neighbours expect. */
static void look_up(PixelSearch *ps)
{
    const FlSearch *search = ps->search;
    ps->angle = search->target->angle[ps->pixel];
    ps->segment = search->target->segment[ps->pixel];
    ps->own_cell = fl_occurrence_cell(search->map, ps->own);
    ps->data = search->cost[ps->pixel];
    ps->own_uniformity = uniformity_cost(ps, ps->own);
    find_carried(ps);
    ps->total = ps->data + ps->own_uniformity + coherence_cost(ps, ps->own);
    ps->n_kept = 0;
}

static void filter_candidates(PixelSearch *ps)
{
    find_expected(ps);
    look_up(ps);
    const FlCandidateFilter filter = filter_of(ps);
    uint32_t uniformity[FL_MAX_CANDIDATES];
    for (uint64_t left = fl_filter_candidates(&ps->candidates, ps->windows->n, &filter, uniformity);
         left; left &= left - 1) {
        const int k = __builtin_ctzll(left);
        keep_candidate(ps, k, uniformity[k]);
    }
}

static void take(PixelSearch *ps, FlMatch match, uint32_t prior, uint32_t data)
{
    if (prior >= ps->total || data >= ps->total - prior)
        return;
    ps->best = match;
    ps->data = data;
    ps->total = data + prior;
}

/* Returns: the number of patch distances started. */
static int try_match(PixelSearch *ps, const FlTargetPatch *patch, FlMatch match,
                     const FlTexel *centre, uint32_t uniformity)
{
    const uint32_t prior = uniformity + coherence_cost(ps, match);
    const uint32_t age = fl_age_cost(ps->search, ps->pixel, match.frame);
    if (prior + age >= ps->total || same_match(match, ps->best))
        return 0;
    take(ps, match, prior,
         age + fl_patch_cost(ps->search, patch, ps->angle, centre, match.theta,
                             ps->total - prior - age - 1));
    return 1;
}

/* True if neither rotation of a match at this place can continue a neighbour's or the carried
 * match. */
static bool stands_apart(const PixelSearch *ps, FlMatch candidate)
{
    for (int k = 0; k < ps->n_expected; k++)
        if (fl_match_same_place(candidate, ps->expected[k]))
            return false;
    return ps->leaving == 0 || !fl_match_same_place(candidate, ps->carried);
}

/* Both rotations of a try [P21 §4.3]; their directions are the target's and add no cost. */
static int try_both(PixelSearch *ps, const FlTargetPatch *patch, const KeptCandidate *c)
{
    const FlSearch *search = ps->search;
    FlMatch turned = c->match;
    turned.theta += 128;
    const bool apart = stands_apart(ps, c->match);
    const uint32_t alone = coherence_apart(ps);
    const uint32_t prior[2] = {c->uniformity + (apart ? alone : coherence_cost(ps, c->match)),
                               c->uniformity + (apart ? alone : coherence_cost(ps, turned))};
    const uint32_t age = fl_age_cost(search, ps->pixel, c->match.frame);
    const uint32_t total = ps->total, lower = age + MIN(prior[0], prior[1]);
    if (lower >= total)
        return 0;
    uint32_t data[2];
    search->kernels->patch_pair(c->centre, search->level->offsets[c->match.theta], patch->guide,
                                &search->target->rest, total - lower - 1, data);
    take(ps, c->match, prior[0], age + data[0]);
    take(ps, turned, prior[1], age + data[1]);
    return (prior[0] < total) + (prior[1] < total);
}

static int propagate(PixelSearch *ps, const FlTargetPatch *patch)
{
    const FlExemplarLevel *level = ps->search->level;
    int tried = 0;
    for (int k = 0; k < ps->n_expected; k++) {
        const FlMatch m = ps->expected[k];
        if (m.frame == FL_NO_MATCH || same_match(m, ps->own))
            continue;
        const FlTexel *centre = fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame);
        if (centre->c[FL_CH_SEGMENT] == ps->segment)
            tried += try_match(ps, patch, m, centre, uniformity_cost(ps, m));
    }
    return tried;
}

/* True if a neighbour has changed since the pixel was last visited. Neighbours that the previous
 * sweep visited first count once more. */
static bool has_news(const PixelSearch *ps)
{
    if (!ps->search->changed || ps->sweep == 0)
        return true;
    const int width = ps->search->nnf->width, height = ps->search->nnf->height;
    const uint8_t *changed = ps->search->changed + ps->pixel;
    return (ps->x > 0 && changed[-1] >= ps->sweep) ||
           (ps->x + 1 < width && changed[1] >= ps->sweep) ||
           (ps->y > 0 && changed[-width] >= ps->sweep) ||
           (ps->y + 1 < height && changed[width] >= ps->sweep);
}

/* True if a neighbour's match continues as another match than the pixel's. */
static bool differs_from_neighbours(PixelSearch *ps)
{
    find_expected(ps);
    for (int k = 0; k < ps->n_expected; k++)
        if (ps->expected[k].frame != FL_NO_MATCH && !same_match(ps->expected[k], ps->own))
            return true;
    return false;
}

/* `stale`: a neighbour's match has changed since filter_candidates(). Returns: whether the pixel's
 * does. */
static bool settle(PixelSearch *ps, bool stale, FlSearchCounts *counts)
{
    const FlSearch *search = ps->search;
    const bool news = has_news(ps);
    FlTargetPatch patch;
    if (!ps->windows) {
        if (!news || !differs_from_neighbours(ps))
            return false;
        look_up(ps);
    } else if (stale) {
        find_expected(ps);
        ps->total = ps->data + ps->own_uniformity + coherence_cost(ps, ps->own);
    }
    fl_target_gather(search->target, ps->x, ps->y, &patch);
    if (news)
        counts->drawn += (uint64_t)ps->n_expected;
    if (ps->windows)
        counts->drawn += (uint64_t)ps->windows->n * (search->params->rotate ? 2 : 1);
    if (news)
        counts->tried += propagate(ps, &patch);
    for (int k = 0; k < ps->n_kept; k++) {
        const KeptCandidate *c = &ps->kept[k];
        counts->tried += search->params->rotate
                             ? try_both(ps, &patch, c)
                             : try_match(ps, &patch, c->match, c->centre, c->uniformity);
    }
    if (same_match(ps->own, ps->best))
        return false;
    counts->accepted++;
    fl_occurrence_move(search->map, ps->segment, ps->own, ps->best);
    search->nnf->match[ps->pixel] = ps->best;
    search->cost[ps->pixel] = ps->data;
    if (search->changed)
        search->changed[ps->pixel] = (uint8_t)(ps->sweep + 1);
    return true;
}

/* Lists a tile's pixels in the order of the scan. Returns their number. */
static int list_pixels(const FlTargetLevel *target, uint32_t tile, bool backwards, Place *pixels)
{
    const int x0 = (int)(tile % target->tile_columns) * FL_TILE;
    const int y0 = (int)(tile / target->tile_columns) * FL_TILE;
    int n = 0;
    for (int k = 0; k < FL_TILE * FL_TILE; k++) {
        const int at = backwards ? FL_TILE * FL_TILE - 1 - k : k;
        const int x = x0 + at % FL_TILE, y = y0 + at / FL_TILE;
        const size_t p = (size_t)y * target->width + x;
        if (x < target->width && y < target->height && fl_target_searches(target, p))
            pixels[n++] = (Place){(uint16_t)x, (uint16_t)y};
    }
    return n;
}

void fl_tile_search_run(const FlTileSearch *tile_search, const uint32_t *tiles, int n, int sweep,
                        FlSearchCounts *counts)
{
    const FlTargetLevel *target = tile_search->search->target;
    Place pixels[FL_TILES_AT_ONCE * FL_TILE * FL_TILE];
    PixelSearch pixel[3];
    int end = 0;
    bool changed = false; // only the pixel before can, between the stages of one
    for (int k = 0; k < n; k++)
        end += list_pixels(target, tiles[k], sweep & 1, pixels + end);
    for (int k = 0; k < end + 2; k++) {
        if (k < end)
            draw(&pixel[k % 3], tile_search, pixels[k], sweep);
        if (k >= 1 && k <= end && pixel[(k - 1) % 3].windows)
            filter_candidates(&pixel[(k - 1) % 3]);
        if (k >= 2)
            changed = settle(&pixel[(k - 2) % 3], changed, counts);
    }
}
