/* The levels of a frame, from coarse to fine [F21 App. B]; private to synth/. */
#pragma once

#include "synth/carry.h"
#include "synth/patchmatch.h"
#include "synth/synth_view.h"

/** The finest level that is searched. Where it is not the finest of all, that one is the coarser
 * level's field, enlarged. */
int fl_synth_finest_searched(const FlSynth *synth);

/** The sharpness of votes: that of the parameters, less for a style that melts. */
float fl_synth_sharpness(const FlSynth *synth);

/**
 * Makes T_temp and m(q) [F21 §3.4] on every level that is searched, and finds what is kept.
 * carried: the last frame's field in the size of the target, shifted in time. FL_ERROR_NO_MEMORY.
 */
bool fl_synth_make_temporal(FlSynth *synth, const FlCarried *carried, GError **error);

/**
 * Searches and votes on all levels: the finest one's field, and its colours unless they are
 * enlarged, are then those of the frame. shifted: that field, if the frame continues another.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_synth_run_levels(FlSynth *synth, const FlNnf *shifted, FlFrameStats *stats, GError **error);

/* ---- the energy of a field, term by term: for statistics, not for the search ---- */

/** Means per pixel in the paper's units: each term with its weight [F21 eq. 1]. */
typedef struct FlEnergy {
    double texture, bound, ext, direction, temporal; // the data terms
    double uniformity, coherence;
} FlEnergy;

/**
 * The energy of search->nnf with the target's colours and T_temp as they are.
 *
 * `target` is search->target; its colours are blended anew for each term and once more at the end.
 * costs: scratch, width * height. Takes about a fifth of a sweep's time.
 */
void fl_energy_of(const FlSearch *search, FlTargetLevel *target, uint32_t *costs, FlEnergy *energy);
