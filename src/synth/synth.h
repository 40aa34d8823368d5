/* One region, frame by frame: the optimisation of [F21 App. B]. */
#pragma once

#include "base/error.h"
#include "synth/guide_pairs.h"
#include "synth/synth_view.h"

/**
 * Sizes of pictures; guides have fl_field_side() of them. A caller may hand over a part of its
 * frames only, whose corner is a multiple of 2^(levels - 1) of the field; the pyramid and the
 * lengths that are shares of a side are the whole frame's all the same.
 */
typedef struct FlSynthSize {
    int width, height;             // of what is painted
    int frame_width, frame_height; // of the whole frames
} FlSynthSize;

/** The exemplar and params must outlive the synthesis. */
FlSynth *fl_synth_new(const FlExemplar *exemplar, const FlParams *params, FlSynthSize size,
                      uint64_t seed);
void fl_synth_free(FlSynth *synth); // NULL is fine

/** Frames fail with FL_ERROR_INTERRUPTED once `stop`, which must outlive the synthesis, asks so. */
void fl_synth_stop_by(FlSynth *synth, const FlStop *stop);

/** Switches the energies in the statistics on or off (default: off). They take a fifth of a frame's
 * time; without them they are 0. */
void fl_synth_measure(FlSynth *synth, bool energies);

/**
 * Paints the next frame. rgb: width * height * 3 sRGB, written in the mask and a rim of 2 px, the
 * style's paper elsewhere. An empty mask makes the next frame a first frame again.
 *
 * Guides are of the frame. Guides that are disposable are cleared as soon as they are used. stats
 * and view may be NULL; without a view only the field and the picture of the frame are kept. With
 * params->rest, a still region keeps its last picture until params->boil is due; stats are then
 * empty.
 */
bool fl_synth_frame(FlSynth *synth, FlGuides *guides, uint8_t *rgb, FlFrameStats *stats,
                    FlSynthView *view, GError **error);

/** Advances by a frame without motion that has the guides, and so the picture, of the frame before.
 * Returns: false if the frame must be painted; the state is then unchanged. */
bool fl_synth_rest(FlSynth *synth);

/** The frames after which paint at rest is dry, or has played the exemplar; 0: it does not show its
 * wetness. Only paint that is carried whole has a known age. */
int fl_synth_drying_frames(const FlExemplar *exemplar, const FlParams *params);

/**
 * The guides of the frame just painted, which must have had a view and levels in its statistics.
 * Returns: false with FL_ERROR_NO_MEMORY set; pairs need clearing in any case.
 */
bool fl_synth_guide_pairs(const FlSynth *synth, FlGuidePairs *pairs, GError **error);

/**
 * The state after the frames painted so far: a synthesis made the same way that loads it paints the
 * same next frame.
 *
 * Returns: to be freed with g_bytes_unref(); NULL with FL_ERROR_NO_MEMORY set.
 */
GBytes *fl_synth_save(FlSynth *synth, GError **error);

/** Returns: false with FL_ERROR_CHANGED if the state is damaged or does not fit; the next frame
 * is then a first frame. */
bool fl_synth_load(FlSynth *synth, GBytes *state, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSynth, fl_synth_free)
