#include "synth/visit.h"

#include "base/rng.h"

/*
 * Where the time goes: a random candidate's texels are a cache miss each, so all tries of a pixel
 * are drawn first and their centres fetched while the neighbours' matches are tested; then those
 * that pass the tests that need the centre alone have their outer texels fetched; then their
 * distances are taken.
 */

/* A random try; its half-turned twin shares everything but theta. */
typedef struct Candidate {
    const FlTexel *centre;
    FlMatch match;
    uint32_t uniformity;
} Candidate;

/* One pixel being matched. */
typedef struct Visit {
    FlTargetPatch patch;
    const FlVisitPlan *plan;
    const FlSearch *search;
    FlSegment segment;
    uint8_t angle;
    FlMatch own; // at the start of the visit: what the occurrence map has counted
    FlCell own_cell;
    FlMatch best;
    uint32_t data;       // fl_match_cost of best
    uint32_t total;      // with uniformity and coherence
    FlMatch expected[4]; // where the neighbours' matches continue
    int n_expected;
    uint64_t tried;
    int n_candidates;
    Candidate candidate[FL_MAX_WINDOWS];
} Visit;

void fl_visit_plan_init(FlVisitPlan *plan, const FlSearch *search)
{
    const FlExemplarLevel *level = search->level;
    const FlParams *params = search->params;
    const float side = (float)MAX(level->width, level->height);
    plan->search = search;
    plan->n_windows = 0;
    for (float share = 1; share * side >= 1 && plan->n_windows < FL_MAX_WINDOWS;
         share *= params->patchmatch_alpha) {
        plan->window[plan->n_windows].x = (uint16_t)(share * level->width);
        plan->window[plan->n_windows].y = (uint16_t)(share * level->height);
        plan->window[plan->n_windows].frame = (uint16_t)(share * level->n_frames + 1);
        plan->n_windows++;
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

static void try_match(Visit *visit, FlMatch candidate, const FlTexel *centre, uint32_t uniformity)
{
    const uint32_t prior = uniformity + coherence_cost(visit, candidate);
    if (prior >= visit->total || same_match(candidate, visit->best))
        return;
    visit->tried++;
    const uint32_t data = fl_patch_cost(visit->search, &visit->patch, visit->angle, centre,
                                        candidate.theta, visit->total - prior - 1);
    if (data < visit->total - prior) {
        visit->best = candidate;
        visit->data = data;
        visit->total = data + prior;
    }
}

/* Left, above, right, below: the scan has just improved the first two or, on odd sweeps, the last
 * two. */
static const int8_t neighbours[4][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};

static void find_expected(Visit *visit, int x, int y)
{
    const FlNnf *nnf = visit->search->nnf;
    visit->n_expected = 0;
    for (int k = 0; k < 4; k++) {
        const int dx = neighbours[k][0], dy = neighbours[k][1];
        const int nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= nnf->width || ny >= nnf->height)
            continue;
        const FlMatch m = nnf->match[(size_t)ny * nnf->width + nx];
        if (m.frame != FL_NO_MATCH)
            visit->expected[visit->n_expected++] =
                fl_match_moved(m, -dx, -dy, visit->search->level);
    }
}

static void propagate(Visit *visit)
{
    const FlExemplarLevel *level = visit->search->level;
    for (int k = 0; k < visit->n_expected; k++) {
        const FlMatch m = visit->expected[k];
        if (m.frame == FL_NO_MATCH || same_match(m, visit->own))
            continue;
        const FlTexel *centre = fl_exemplar_at(level, fl_match_x(m), fl_match_y(m), m.frame);
        if (centre->c[FL_CH_SEGMENT] == visit->segment)
            try_match(visit, m, centre, uniformity_cost(visit, m));
    }
}

/* Uniform within `radius` of the centre and 0 … size - 1; bits is 21 random bits. */
static int random_within(uint64_t bits, int centre, int radius, int size)
{
    const int low = MAX(centre - radius, 0), high = MIN(centre + radius, size - 1);
    return low + (int)(((bits & 0x1fffff) * (uint64_t)(high - low + 1)) >> 21);
}

/* Draws from windows around the own match, smaller by alpha each try, and fetches the centres. */
static void draw(Visit *visit, uint64_t key)
{
    const FlVisitPlan *plan = visit->plan;
    const FlExemplarLevel *level = visit->search->level;
    const int x = fl_match_x(visit->own), y = fl_match_y(visit->own);
    for (int k = 0; k < plan->n_windows; k++) {
        Candidate *c = &visit->candidate[k];
        const uint64_t bits = fl_hash64(key + (uint64_t)k * 0x9e3779b97f4a7c15u);
        const int cx = random_within(bits, x, plan->window[k].x, level->width);
        const int cy = random_within(bits >> 21, y, plan->window[k].y, level->height);
        const int t =
            random_within(bits >> 42, visit->own.frame, plan->window[k].frame, level->n_frames);
        c->match = (FlMatch){(uint16_t)(16 * cx), (uint16_t)(16 * cy), (int16_t)t, 0, 0};
        c->centre = fl_exemplar_at(level, cx, cy, t);
        __builtin_prefetch(c->centre);
    }
}

/* Keeps the candidates of the segment that the uniformity term does not rule out. */
static void sift(Visit *visit)
{
    int n = 0;
    for (int k = 0; k < visit->plan->n_windows; k++) {
        Candidate c = visit->candidate[k];
        if (c.centre->c[FL_CH_SEGMENT] != visit->segment)
            continue;
        c.uniformity = uniformity_cost(visit, c.match);
        if (c.uniformity >= visit->total)
            continue;
        if (visit->search->params->rotate)
            c.match.theta = (uint8_t)(visit->angle - c.centre->c[FL_CH_ANGLE]);
        const int32_t *offsets = visit->search->level->offsets[c.match.theta];
        for (int p = 0; p < 8; p++) // the outer ring: the lines between are mostly the same
            __builtin_prefetch(c.centre + offsets[p]);
        visit->candidate[n++] = c;
    }
    visit->n_candidates = n;
}

/* Both rotations of each [P21 §4.3]. */
static void try_candidates(Visit *visit)
{
    for (int k = 0; k < visit->n_candidates; k++) {
        Candidate *c = &visit->candidate[k];
        try_match(visit, c->match, c->centre, c->uniformity);
        if (!visit->search->params->rotate)
            continue;
        c->match.theta += 128;
        try_match(visit, c->match, c->centre, c->uniformity);
    }
}

void fl_visit_pixel(const FlVisitPlan *plan, int x, int y, uint64_t key, FlSearchCounts *counts)
{
    const FlSearch *search = plan->search;
    const size_t p = (size_t)y * search->target->width + x;
    Visit visit;
    visit.plan = plan;
    visit.search = search;
    visit.angle = search->target->angle[p];
    visit.segment = search->target->segment[p];
    visit.own = visit.best = search->nnf->match[p];
    visit.own_cell = fl_occurrence_cell(search->map, visit.own);
    visit.data = search->cost[p];
    visit.tried = 0;
    draw(&visit, fl_key(key, p));
    fl_target_gather(search->target, x, y, &visit.patch);
    find_expected(&visit, x, y);
    visit.total =
        visit.data + uniformity_cost(&visit, visit.best) + coherence_cost(&visit, visit.best);
    propagate(&visit);
    sift(&visit);
    try_candidates(&visit);
    counts->tried += visit.tried;
    if (same_match(visit.own, visit.best))
        return;
    counts->accepted++;
    fl_occurrence_move(search->map, visit.segment, visit.own, visit.best);
    search->nnf->match[p] = visit.best;
    search->cost[p] = visit.data;
}
