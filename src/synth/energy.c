#include "synth/synth_levels.h"

/* Params with all weights 0 and rotation off: with rotation off, a turned patch adds no cost. */
static FlParams no_weights(const FlParams *params)
{
    FlParams none = *params;
    none.w_texture = none.w_bound = none.w_ext = none.w_temp = none.w_uni = none.w_coh = 0;
    none.w_age = 0;
    none.rotate = false;
    return none;
}

/* Mean cost of the field with only some weights, in the scale of the search. */
static double mean_cost(const FlSearch *search, FlTargetLevel *target, const FlParams *some,
                        uint32_t *cost)
{
    FlSearch part = *search;
    part.params = some;
    fl_target_blend(target, some, search->scale, some->w_texture);
    part.cost = cost;
    fl_search_costs(&part, NULL);
    uint64_t sum = 0, n = 0;
    for (size_t p = 0; p < (size_t)target->width * target->height; p++)
        if (target->segment[p] != FL_SEGMENT_OUTSIDE)
            sum += cost[p], n++;
    return n > 0 ? (double)sum / search->scale->unit / (double)n : 0;
}

static double mean_uniformity(const FlSearch *search)
{
    const FlTargetLevel *target = search->target;
    uint64_t sum = 0, n = 0;
    for (size_t p = 0; p < (size_t)target->width * target->height; p++) {
        const FlMatch m = search->nnf->match[p];
        if (m.frame == FL_NO_MATCH)
            continue;
        const FlCell cell = fl_occurrence_cell(search->map, m);
        sum += fl_occurrence_cost(search->map, target->segment[p], cell, cell), n++;
    }
    return n > 0 ? (double)sum / search->scale->unit / (double)n : 0;
}

static double mean_coherence(const FlSearch *search)
{
    const FlTargetLevel *target = search->target;
    double sum = 0, n = 0;
    for (size_t p = 0; p < (size_t)target->width * target->height; p++) {
        const FlMatch m = search->nnf->match[p];
        if (m.frame == FL_NO_MATCH)
            continue;
        FlMatch expected[FL_NEIGHBOURS];
        const int beside = fl_matches_beside(search, (int)(p % (size_t)target->width),
                                             (int)(p / (size_t)target->width), expected);
        int apart = 0;
        for (int k = 0; k < beside; k++)
            apart += !fl_match_continues(m, expected[k]);
        sum += beside > 0 ? (double)apart / beside : 0, n++;
    }
    return n > 0 ? search->w_coh * sum / n : 0;
}

void fl_energy_of(const FlSearch *search, FlTargetLevel *target, uint32_t *costs, FlEnergy *energy)
{
    const FlParams *all = search->params;
    FlParams texture = no_weights(all), bound = texture, ext = texture, direction = texture,
             temporal = texture;
    texture.w_texture = all->w_texture;
    bound.w_bound = all->w_bound;
    ext.w_ext = all->w_ext;
    direction.rotate = all->rotate; // its cost comes from the scale's table
    temporal.w_temp = all->w_temp;
    energy->texture = mean_cost(search, target, &texture, costs);
    energy->bound = mean_cost(search, target, &bound, costs);
    energy->ext = mean_cost(search, target, &ext, costs);
    energy->direction = mean_cost(search, target, &direction, costs);
    energy->temporal = mean_cost(search, target, &temporal, costs);
    energy->uniformity = mean_uniformity(search);
    energy->coherence = mean_coherence(search);
    fl_target_blend(target, all, search->scale, all->w_texture);
}
