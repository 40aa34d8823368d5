#include "synth/patch_cost.h"

/* Whether the rotated source flow opposes the target's: the two extents then swap [F21 §3.3]. */
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

uint32_t fl_match_cost(const FlSearch *search, int x, int y, FlMatch match)
{
    FlTargetPatch patch;
    fl_target_gather(search->target, x, y, &patch);
    const FlTexel *centre =
        fl_exemplar_at(search->level, fl_match_x(match), fl_match_y(match), match.frame);
    return fl_patch_cost(search, &patch,
                         search->target->angle[(size_t)y * search->target->width + x], centre,
                         match.theta, UINT32_MAX >> 1);
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

double fl_mean_cost(const FlSearch *search)
{
    uint64_t sum = 0, n = 0;
    for (size_t p = 0; p < (size_t)search->nnf->width * search->nnf->height; p++)
        if (search->nnf->match[p].frame != FL_NO_MATCH)
            sum += search->cost[p], n++;
    return n > 0 ? (double)sum / (double)n : 0;
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
