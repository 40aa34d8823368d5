#include "synth/shift.h"

#include "base/curves.h"
#include <math.h>

/**
 * Moves a match by the number of exemplar frames in which the paint at its place moves as far as
 * `motion_px`: forwards, or backwards where the target moves against the rotated exemplar
 * (`opposes`). Never beyond a frame in which the place has no paint. Of frames whose motion is
 * equally near, the first in that direction, so that still paint stays in its frame.
 */
static FlMatch shifted_match(const FlExemplar *exemplar, FlMatch match, float motion_px,
                             bool opposes)
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const size_t frame = (size_t)full->width * full->height;
    const size_t pixel = (size_t)fl_match_y(match) * full->width + fl_match_x(match);
    const float *extent = opposes ? exemplar->ext_minus : exemplar->ext_plus;
    const int step = opposes ? -1 : 1;
    const float start = extent[match.frame * frame + pixel];
    float best = motion_px;
    int best_frame = match.frame;
    for (int t = match.frame + step; fl_exemplar_has(full, t); t += step) {
        if (exemplar->mask[t * frame + pixel] < FL_INSIDE)
            break;
        const float moved = extent[t * frame + pixel] - start;
        const float miss = moved < motion_px ? motion_px - moved : moved - motion_px;
        if (miss < best)
            best = miss, best_frame = t;
        if (moved > 2 * motion_px + 1)
            break;
    }
    match.frame = (int16_t)best_frame;
    return match;
}

static bool opposes(const FlExemplar *exemplar, FlMatch m, uint8_t target_angle)
{
    const int source_angle =
        fl_exemplar_at(&exemplar->level[0], fl_match_x(m), fl_match_y(m), m.frame)->c[FL_CH_ANGLE];
    const uint8_t turn = (uint8_t)(m.theta + source_angle - target_angle);
    return turn > 64 && turn < 192;
}

/* One frame forwards or backwards, unless there is no paint at its place. */
static FlMatch boil_step(const FlExemplar *exemplar, FlMatch match, int step)
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const size_t frame = (size_t)full->width * full->height;
    const size_t pixel = (size_t)fl_match_y(match) * full->width + fl_match_x(match);
    const int t = match.frame + step;
    if (fl_exemplar_has(full, t) && exemplar->mask[t * frame + pixel] >= FL_INSIDE)
        match.frame = (int16_t)t;
    return match;
}

/* Moves a match outside the window to its nearest frame. A match without paint in that frame is
 * dropped. */
static FlMatch moved_into_window(const FlExemplar *exemplar, FlMatch match)
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const int t = CLAMP(match.frame, full->first, full->first + full->window - 1);
    const size_t row = (size_t)t * (size_t)full->height + (size_t)fl_match_y(match);
    if (t == match.frame)
        return match;
    match.frame = (int16_t)t;
    if (exemplar->mask[row * (size_t)full->width + (size_t)fl_match_x(match)] < FL_INSIDE)
        match.frame = FL_NO_MATCH;
    return match;
}

int fl_boil_step(float boil, int frame, int n_frames)
{
    const int before = (int)floor((double)boil * (frame - 1)),
              now = (int)floor((double)boil * frame);
    const int turn = CLAMP(n_frames - 1, 1, FL_BOIL_TURN);
    return now == before ? 0 : before % (2 * turn) < turn ? 1 : -1;
}

void fl_nnf_shift(FlNnf *nnf, const FlExemplar *exemplar, const FlTargetMotion *motion)
{
    const size_t pixels = (size_t)nnf->width * nnf->height;
#pragma omp parallel for schedule(dynamic, 4096)
    for (size_t p = 0; p < pixels; p++) {
        FlMatch *m = &nnf->match[p];
        if (m->frame != FL_NO_MATCH)
            *m = moved_into_window(exemplar, *m);
        if (m->frame == FL_NO_MATCH)
            continue;
        if (motion->boil != 0 && motion->speed[p] <= motion->still)
            *m = boil_step(exemplar, *m, motion->boil);
        else
            *m = shifted_match(exemplar, *m, motion->speed[p],
                               opposes(exemplar, *m, motion->angle[p]));
    }
}

static float weight_of(float apart, const FlTemporalTrust *trust)
{
    return 1 - fl_smooth((apart - trust->lower_px) / (trust->upper_px - trust->lower_px));
}

float fl_temporal_weight(const FlExemplar *exemplar, FlMatch shifted, float target_distance_px,
                         const FlTemporalTrust *trust)
{
    const FlExemplarLevel *full = &exemplar->level[0];
    const size_t row = (size_t)shifted.frame * (size_t)full->height + (size_t)fl_match_y(shifted);
    const float source =
        exemplar->distance[row * (size_t)full->width + (size_t)fl_match_x(shifted)];
    const float border = exemplar->border_px;
    const float weight = weight_of(fabsf(source - target_distance_px), trust);
    const float most =
        weight_of(fabsf(MIN(source, border) - MIN(target_distance_px, border)), trust);
    return weight + trust->below_border * (most - weight);
}
