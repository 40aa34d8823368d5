/* From frame to frame: matches move on in the exemplar's time [F21 §3.4]. */
#pragma once

#include "synth/nnf.h"

/** The target's motion between two frames: arrays of width * height of the field. */
typedef struct FlTargetMotion {
    const float *speed;   // px from the field's frame to the next
    const uint8_t *angle; // its direction
    float still;          // px: no faster counts as still …
    int boil;             // … and boils: steps so many frames of the exemplar, -1 … 1
} FlTargetMotion;

/** Shifts a level-0 field; matches outside the exemplar's window first move to its nearest
 * frame. */
void fl_nnf_shift(FlNnf *nnf, const FlExemplar *exemplar, const FlTargetMotion *motion);

/**
 * The step of still paint before the frame-th painted frame, from 1: a share `boil` of the frames
 * take one. Steps go back and forth, FL_BOIL_TURN each way (less in a shorter exemplar), since the
 * exemplar ends but stillness may not.
 */
int fl_boil_step(float boil, int frame, int n_frames);

#define FL_BOIL_TURN 12

/** The limits of trust in the last frame's matches [F21 §3.4]. */
typedef struct FlTemporalTrust {
    float lower_px, upper_px; // differences of depth: m_l, m_u
    float below_border;       // 0 … 1: how far all depths below the border are taken for the same
} FlTemporalTrust;

/**
 * The temporal weight m(q) [F21 §3.4]: 1 where the shifted match lies as deep in its paint as q in
 * the target, 0 where the depths differ by upper_px or more. (The paper prints the opposite, which
 * would trust the previous frame most where it fits worst.) In a shape that is much deeper than
 * the exemplar's paint that is 0 in the middle, which is painted anew in every frame; so what is
 * to be carried asks for below_border.
 */
float fl_temporal_weight(const FlExemplar *exemplar, FlMatch shifted, float target_distance_px,
                         const FlTemporalTrust *trust);
