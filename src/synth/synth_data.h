/* The data of an FlSynth; private to synth/. */
#pragma once

#include "base/error.h"
#include "synth/rest.h"
#include "synth/synth_state.h"
#include "synth/synth_view.h"

struct FlSynth {
    const FlExemplar *exemplar;
    const FlParams *params;
    const FlStop *stop;
    FlCostScale scale;
    FlKernels kernels;
    int width, height, n_levels;
    float side; // the larger one of the whole frames, px
    uint64_t key;
    FlSynthState last; // after the last frame
    int boil;          // fl_boil_step() before the frame in hand
    bool moves;        // the drawing's motion is known in the frame in hand
    bool wants_energies;
    double seconds_search, seconds_vote; // of the frame in hand
    uint8_t *tone;   // of the frame in hand, of its rect: fl_drying_step(); NULL: it is 1
    FlTarget target; // of the frame in hand; kept until the next for FlSynthView
    FlNnf nnf[FL_MAX_LEVELS];
    FlSynthView view; // of the last frame that was painted, where it is needed
};

/** Seconds since a monotonic time, which moves on to now. */
static inline double fl_lap(gint64 *since)
{
    const gint64 now = g_get_monotonic_time(), before = *since;
    *since = now;
    return (double)(now - before) * 1e-6;
}
