#include "synth/patchmatch.h"

#include "base/rng.h"

/* The target patch around a pixel, and the same with its extents swapped. */
typedef struct Patch {
    _Alignas(64) FlPacked guide[FL_PATCH_PIXELS + 3];
    _Alignas(64) FlPacked swapped[FL_PATCH_PIXELS + 3];
    _Alignas(64) FlPacked weight[FL_PATCH_PIXELS + 3];
} Patch;

/* One pixel being matched. */
typedef struct Visit {
    const FlSearch *search;
    Patch patch;
    int x, y;
    uint8_t angle;
    FlSegment segment;
    FlMatch own; // at the start of the visit: what the occurrence map has counted
    FlMatch best;
    uint32_t data;       // fl_match_cost of best
    uint32_t total;      // with uniformity and coherence
    FlMatch expected[4]; // where the neighbours' matches continue
    int n_expected;
    uint64_t tried;
} Visit;

static void gather(Visit *visit)
{
    Patch *patch = &visit->patch;
    fl_target_gather(visit->search->target, visit->x, visit->y, patch->guide, patch->weight);
    for (int k = 0; k < FL_PATCH_PIXELS; k++) {
        patch->swapped[k] = patch->guide[k];
        patch->swapped[k].c[FL_CH_EXT_PLUS] = patch->guide[k].c[FL_CH_EXT_MINUS];
        patch->swapped[k].c[FL_CH_EXT_MINUS] = patch->guide[k].c[FL_CH_EXT_PLUS];
    }
}

/* The source flow, rotated, opposes the target's: past and future motion change roles [F21 §3.3].
 */
static bool opposes(uint8_t turn)
{
    return turn > 64 && turn < 192;
}

static uint32_t patch_cost(const Visit *visit, const FlTexel *centre, uint8_t theta, uint32_t limit)
{
    const FlSearch *search = visit->search;
    const uint8_t turn = (uint8_t)(theta + centre->c[FL_CH_ANGLE] - visit->angle);
    const uint32_t direction = search->params->rotate ? search->scale->direction[turn] : 0;
    if (direction > limit)
        return direction;
    return direction + search->kernels->patch_distance(centre, search->level->offsets[theta],
                                                       opposes(turn) ? visit->patch.swapped
                                                                     : visit->patch.guide,
                                                       visit->patch.weight, limit - direction);
}

uint32_t fl_match_cost(const FlSearch *search, int x, int y, FlMatch match)
{
    Visit visit = {.search = search,
                   .x = x,
                   .y = y,
                   .angle = search->target->angle[(size_t)y * search->target->width + x]};
    gather(&visit);
    const FlTexel *centre =
        fl_exemplar_at(search->level, fl_match_x(match), fl_match_y(match), match.frame);
    return patch_cost(&visit, centre, match.theta, UINT32_MAX >> 1);
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

/* Two matches show the same piece of the exemplar: same frame and rotation, within 3/4 px. */
static bool continues(FlMatch a, FlMatch b)
{
    return a.frame == b.frame && abs(a.x_16 - b.x_16) < 12 && abs(a.y_16 - b.y_16) < 12 &&
           fl_angle_distance((uint8_t)(a.theta - b.theta)) < 8;
}

static uint32_t coherence_cost(const Visit *visit, FlMatch candidate)
{
    if (visit->search->params->w_coh <= 0 || visit->n_expected == 0)
        return 0;
    int apart = 0;
    for (int k = 0; k < visit->n_expected; k++)
        apart += !continues(candidate, visit->expected[k]);
    return (uint32_t)(visit->search->params->w_coh * visit->search->scale->unit * apart /
                      visit->n_expected);
}

static uint32_t prior_cost(const Visit *visit, FlMatch candidate)
{
    return fl_occurrence_cost(visit->search->map, visit->segment, candidate, visit->own) +
           coherence_cost(visit, candidate);
}

static bool same_match(FlMatch a, FlMatch b)
{
    return a.x_16 == b.x_16 && a.y_16 == b.y_16 && a.frame == b.frame && a.theta == b.theta;
}

static void try_match(Visit *visit, FlMatch candidate, const FlTexel *centre)
{
    const uint32_t prior = prior_cost(visit, candidate);
    if (prior >= visit->total || same_match(candidate, visit->best))
        return;
    visit->tried++;
    const uint32_t data = patch_cost(visit, centre, candidate.theta, visit->total - prior - 1);
    if (data < visit->total - prior) {
        visit->best = candidate;
        visit->data = data;
        visit->total = data + prior;
    }
}

/* Neighbours in the order left, above, right, below; the scan has just improved the first two or,
 * on odd sweeps, the last two. */
static const int8_t neighbours[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};

static void find_expected(Visit *visit)
{
    const FlSearch *search = visit->search;
    visit->n_expected = 0;
    for (int k = 0; k < 4; k++) {
        const int dx = neighbours[k][0], dy = neighbours[k][1];
        const int nx = visit->x + dx, ny = visit->y + dy;
        if (nx < 0 || ny < 0 || nx >= search->nnf->width || ny >= search->nnf->height)
            continue;
        const FlMatch m = search->nnf->match[(size_t)ny * search->nnf->width + nx];
        if (m.frame == FL_NO_MATCH)
            continue;
        visit->expected[visit->n_expected++] = fl_match_moved(m, -dx, -dy, search->level);
    }
}

static void propagate(Visit *visit)
{
    const FlExemplarLevel *level = visit->search->level;
    for (int k = 0; k < visit->n_expected; k++) {
        const FlMatch m = visit->expected[k];
        if (m.frame == FL_NO_MATCH)
            continue;
        const FlTexel *centre = fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame);
        if (centre->c[FL_CH_SEGMENT] == visit->segment)
            try_match(visit, m, centre);
    }
}

static int random_within(FlRng *rng, int centre, float radius, int size)
{
    const int r = (int)radius;
    const int low = MAX(centre - r, 0), high = MIN(centre + r, size - 1);
    return low + (int)fl_rng_below(rng, (uint32_t)(high - low + 1));
}

/* Windows around the best match, smaller by alpha each try; both rotations of each [P21 §4.3]. */
static void random_search(Visit *visit, uint64_t key)
{
    const FlExemplarLevel *level = visit->search->level;
    const FlParams *params = visit->search->params;
    FlRng rng = {key};
    const float side = (float)MAX(level->width, level->height);
    for (float share = 1; share * side >= 1; share *= params->patchmatch_alpha) {
        FlMatch m = {0};
        const int x =
            random_within(&rng, fl_match_x(visit->best), share * level->width, level->width);
        const int y =
            random_within(&rng, fl_match_y(visit->best), share * level->height, level->height);
        m.frame = (int16_t)random_within(&rng, visit->best.frame, share * level->n_frames + 1,
                                         level->n_frames);
        const FlTexel *centre = fl_exemplar_at(level, x, y, m.frame);
        if (centre->c[FL_CH_SEGMENT] != visit->segment)
            continue;
        m.x_16 = (uint16_t)(16 * x), m.y_16 = (uint16_t)(16 * y);
        if (params->rotate)
            m.theta = (uint8_t)(visit->angle - centre->c[FL_CH_ANGLE]);
        try_match(visit, m, centre);
        m.theta += 128;
        if (params->rotate)
            try_match(visit, m, centre);
    }
}

static void visit_pixel(const FlSearch *search, int x, int y, uint64_t key, FlSearchCounts *counts)
{
    const size_t p = (size_t)y * search->target->width + x;
    Visit visit;
    visit.search = search;
    visit.x = x, visit.y = y;
    visit.angle = search->target->angle[p];
    visit.segment = search->target->segment[p];
    visit.own = visit.best = search->nnf->match[p];
    visit.data = search->cost[p];
    visit.tried = 0;
    gather(&visit);
    find_expected(&visit);
    visit.total = visit.data + prior_cost(&visit, visit.best);
    propagate(&visit);
    random_search(&visit, fl_key(key, p));
    counts->tried += visit.tried;
    if (same_match(visit.own, visit.best))
        return;
    counts->accepted++;
    fl_occurrence_move(search->map, visit.segment, visit.own, visit.best);
    search->nnf->match[p] = visit.best;
    search->cost[p] = visit.data;
}

/* Scans a tile forwards or backwards. */
static void visit_tile(const FlSearch *search, uint32_t tile, bool backwards, uint64_t key,
                       FlSearchCounts *counts)
{
    const FlTargetLevel *target = search->target;
    const int x0 = (int)(tile % target->tile_columns) * FL_TILE;
    const int y0 = (int)(tile / target->tile_columns) * FL_TILE;
    for (int k = 0; k < FL_TILE * FL_TILE; k++) {
        const int at = backwards ? FL_TILE * FL_TILE - 1 - k : k;
        const int x = x0 + at % FL_TILE, y = y0 + at / FL_TILE;
        if (x < target->width && y < target->height &&
            target->segment[(size_t)y * target->width + x] != FL_SEGMENT_OUTSIDE)
            visit_pixel(search, x, y, key, counts);
    }
}

static void visit_class(const FlSearch *search, int class, bool backwards, uint64_t key,
                        FlSearchCounts *counts)
{
    uint64_t tried = 0, accepted = 0;
    const int first = search->target->n_tiles[class], end = search->target->n_tiles[class + 1];
#pragma omp parallel for schedule(dynamic, 1) reduction(+ : tried, accepted)
    for (int k = first; k < end; k++) {
        FlSearchCounts own = {0};
        visit_tile(search, search->target->tiles[k], backwards, key, &own);
        tried += own.tried;
        accepted += own.accepted;
    }
    counts->tried += tried;
    counts->accepted += accepted;
    fl_occurrence_refresh(search->map);
}

FlSearchCounts fl_search_run(FlSearch *search, int sweeps)
{
    FlSearchCounts counts = {0};
    for (int sweep = 0; sweep < sweeps; sweep++)
        for (int k = 0; k < FL_TILE_CLASSES; k++) {
            const bool backwards = sweep & 1;
            const int class = backwards ? FL_TILE_CLASSES - 1 - k : k;
            visit_class(search, class, backwards, fl_key(search->key, (uint64_t)sweep), &counts);
        }
    return counts;
}
