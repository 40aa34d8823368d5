/* From frame to frame: matches move on in the exemplar's time [F21 §3.4]. */
#ifndef FLUIDY_SYNTH_SHIFT_H
#define FLUIDY_SYNTH_SHIFT_H

#include "synth/nnf.h"

/**
 * Moves a match by the number of exemplar frames in which the paint at its place moves as far as
 * `motion_px`: forwards, or backwards where the target moves against the rotated exemplar
 * (`opposes`). Never past a frame in which the place has no paint.
 */
FlMatch fl_match_shifted(const FlExemplar *exemplar, FlMatch match, float motion_px, bool opposes);

/**
 * Shifts a level-0 field. `motion` is the target's, px from the field's frame to the next, and
 * `angle` its direction, both width * height of the field.
 */
void fl_nnf_shift(FlNnf *nnf, const FlExemplar *exemplar, const float *motion,
                  const uint8_t *angle);

/**
 * The temporal weight m(q) [F21 §3.4]: 1 where the shifted match lies as deep in its paint as q in
 * the target, 0 where the depths differ by upper_px or more. (The paper prints the opposite, which
 * would trust the previous frame most where it fits worst.)
 */
float fl_temporal_weight(const FlExemplar *exemplar, FlMatch shifted, float target_distance_px,
                         float lower_px, float upper_px);

#endif
