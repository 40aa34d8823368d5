/* LazyFluids: one region, frame by frame, by an exemplar that rides on the motion [L15]. */
#pragma once

#include "params/region_settings.h"
#include "synth/guide_pairs.h"
#include "synth/synth.h"

/**
 * The synthesis of one region: it keeps the output of the last frame.
 *
 * Of params it reads: w_bound (eta) and w_temp (lambda), w_uni (0: nearest neighbours, below 1:
 * along the border, else strict), uniform_blocks, border (the band of blurred alpha), shape_edge
 * (0: alpha is the mask with its bare margin), rotate (four quarter turns), the rounds,
 * finest_sweeps, half_size (less search: drafts), vote_sharpness, rest and motion_blur.
 */
typedef struct FlLazy FlLazy;

/** The exemplar and params must outlive it. */
FlLazy *fl_lazy_new(const FlExemplar *exemplar, const FlParams *params, FlRecordingEnd end,
                    FlSynthSize size, uint64_t seed, GError **error);
void fl_lazy_free(FlLazy *lazy); // NULL is fine

/** Switches the terms of the energy in the statistics on or off (default: off). */
void fl_lazy_measure(FlLazy *lazy, bool terms);

/**
 * Paints the next frame with the exemplar's frame in step; see FlRecordingEnd. rgb:
 * width * height * 3 sRGB, its paper without paint: as composited over the paper, but straight
 * colours for a cut-out. alpha: width * height, synthesised as the colours are; or NULL. An empty
 * mask makes the next frame a first frame. Disposable guides are cleared before paint is made.
 * stats and view may be NULL.
 */
bool fl_lazy_frame(FlLazy *lazy, FlGuides *guides, uint8_t *rgb, uint8_t *alpha,
                   FlFrameStats *stats, FlSynthView *view, GError **error);

/** The distance to which alpha extends beyond the region's mask, px. */
float fl_lazy_reach(const FlExemplar *exemplar, const FlParams *params);

/** As fl_synth_guide_pairs(). */
bool fl_lazy_guide_pairs(const FlLazy *lazy, FlGuidePairs *pairs, GError **error);

/** As fl_synth_save() and fl_synth_load(). */
GBytes *fl_lazy_save(FlLazy *lazy, GError **error);
bool fl_lazy_load(FlLazy *lazy, GBytes *state, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlLazy, fl_lazy_free)
