#include "synth/patch_cost.h"

/* True if the rotated source flow opposes the target's: the two extents then swap [F21 §3.3]. */
static bool opposes(uint8_t turn)
{
    return turn > 64 && turn < 192;
}

uint32_t fl_patch_cost(const FlSearch *search, const FlTargetPatch *patch, uint8_t target_angle,
                       const FlTexel *centre, uint8_t theta, uint32_t limit)
{
    const uint8_t turn = (uint8_t)(theta + centre->c[FL_CH_ANGLE] - target_angle);
    const uint32_t direction = search->params->rotate ? search->scale->direction[turn] : 0;
    if (direction > limit)
        return direction;
    return direction + search->kernels->patch_distance(centre, search->level->offsets[theta],
                                                       opposes(turn), patch->guide,
                                                       &search->target->rest, limit - direction);
}

static const FlTexel *centre_of(const FlSearch *search, FlMatch m)
{
    return fl_exemplar_at(search->level, fl_match_x(m), fl_match_y(m), m.frame);
}

/* That of a match with its centre, against the patch around pixel p. */
static uint32_t cost_of(const FlSearch *search, const FlTargetPatch *patch, size_t p, FlMatch match,
                        const FlTexel *centre, uint32_t limit)
{
    return fl_age_cost(search, p, match.frame) +
           fl_patch_cost(search, patch, search->target->angle[p], centre, match.theta, limit);
}

uint32_t fl_match_cost(const FlSearch *search, int x, int y, FlMatch match)
{
    const size_t p = (size_t)y * search->target->width + x;
    FlTargetPatch patch;
    fl_target_gather(search->target, x, y, &patch);
    return cost_of(search, &patch, p, match, centre_of(search, match), UINT32_MAX >> 1);
}

/* Mean Laplacian of a star in style 02 that turns by 3 degrees a frame, at carry 1, frames 10 and
 * 395: 7.6 and 6.7 with 4, 7.7 and 7.3 with 8 or 16; but with 16 rims get rough as the shape turns.
 */
#define LEAVING 8 // times w_coh

uint32_t fl_leaving_cost(const FlSearch *search, size_t pixel)
{
    if (!search->carried || search->carried->match[pixel].frame == FL_NO_MATCH)
        return 0;
    const double cost = LEAVING * search->params->w_coh * search->scale->unit *
                        search->target->temporal_weight[pixel];
    return (uint32_t)MIN(cost, 1 << 29);
}

int fl_matches_beside(const FlSearch *search, int x, int y, FlMatch expected[FL_NEIGHBOURS])
{
    // the scan has just improved the first two or, on odd sweeps, the last two
    static const int8_t steps[FL_NEIGHBOURS][2] = {{-1, 0}, {0, -1}, {1, 0}, {0, 1}};
    const FlNnf *nnf = search->nnf;
    int n = 0;
    for (int k = 0; k < FL_NEIGHBOURS; k++) {
        const int dx = steps[k][0], dy = steps[k][1], nx = x + dx, ny = y + dy;
        if (nx < 0 || ny < 0 || nx >= nnf->width || ny >= nnf->height)
            continue;
        const FlMatch m = nnf->match[(size_t)ny * nnf->width + nx];
        if (m.frame != FL_NO_MATCH)
            expected[n++] = fl_match_moved(m, -dx, -dy, search->level);
    }
    return n;
}

/* Adds the costs of a block's matches. */
static void add_costs(const FlSearch *search, FlRect block, uint64_t *sum, uint64_t *n)
{
    for (int y = block.y; y < block.y + block.height; y++)
        for (int x = block.x; x < block.x + block.width; x++) {
            const size_t p = (size_t)y * (size_t)search->nnf->width + (size_t)x;
            if (search->nnf->match[p].frame != FL_NO_MATCH)
                *sum += search->cost[p], ++*n;
        }
}

double fl_mean_cost(const FlSearch *search)
{
    const FlBlocks *blocks = &search->target->blocks;
    uint64_t sum = 0, n = 0;
#pragma omp parallel for schedule(static) reduction(+ : sum, n)
    for (int k = 0; k < blocks->n; k++)
        add_costs(search, blocks->block[k], &sum, &n);
    return n > 0 ? (double)sum / (double)n : 0;
}

/* The match of `previous` takes the place of the pixel's own if it is allowed to and costs less. */
static void merge(FlSearch *search, const FlNnf *previous, const FlTargetPatch *patch, size_t p)
{
    const FlMatch m = previous->match[p];
    const uint32_t limit = search->cost[p] + fl_leaving_cost(search, p);
    if (m.frame == FL_NO_MATCH || limit == 0)
        return;
    const FlTexel *centre = centre_of(search, m);
    if (centre->c[FL_CH_SEGMENT] != search->target->segment[p])
        return;
    const uint32_t cost = cost_of(search, patch, p, m, centre, limit - 1);
    if (cost < limit)
        search->nnf->match[p] = m, search->cost[p] = cost;
}

static void cost_pixel(FlSearch *search, const FlNnf *previous, int x, int y)
{
    const size_t p = (size_t)y * search->nnf->width + x;
    const FlMatch m = search->nnf->match[p];
    FlTargetPatch patch;
    search->cost[p] = UINT32_MAX;
    if (m.frame == FL_NO_MATCH)
        return;
    fl_target_gather(search->target, x, y, &patch);
    search->cost[p] = cost_of(search, &patch, p, m, centre_of(search, m), UINT32_MAX >> 1);
    if (previous)
        merge(search, previous, &patch, p);
}

void fl_search_costs(FlSearch *search, const FlNnf *previous)
{
    const FlBlocks *blocks = &search->target->blocks;
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = 0; k < blocks->n; k++) {
        const FlRect block = blocks->block[k];
        for (int y = block.y; y < block.y + block.height; y++)
            for (int x = block.x; x < block.x + block.width; x++)
                cost_pixel(search, previous, x, y);
    }
}
