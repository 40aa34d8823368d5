/* The guides of a frame as pictures for ebsynth, with its command line: --ebsynth. */
#pragma once

#include "compose/painted_region.h"
#include "synth/guide_pairs.h"

/** Writes folder/run.sh, which runs all steps, and folder/README. FL_ERROR_OUTPUT. */
bool fl_ebsynth_begin(const char *folder, GError **error);

/**
 * Writes the step of a region's frame into folder/REGION/: style_NUMBER.png, WHAT_source_NUMBER.png
 * and WHAT_target_NUMBER.png of each pair, and run_NUMBER.sh, which makes out_NUMBER.png of them,
 * as large as painted->rect: FL_EBSYNTH_OUTPUT.
 *
 * pairs NULL: the frame was not synthesised. run_NUMBER.sh then copies the output of frame
 * `before`; without one (-1), or where the region is not in the frame, out_NUMBER.png is written at
 * once: the paint as it is. Returns: false with FL_ERROR_OUTPUT or FL_ERROR_NO_MEMORY set.
 */
bool fl_ebsynth_frame(const char *folder, const FlPaintedRegion *painted, const FlGuidePairs *pairs,
                      int number, int before, GError **error);
