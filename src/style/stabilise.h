/* Small camera shake: estimated on the bare paper, removed from the frames. */
#ifndef FLUIDY_STYLE_STABILISE_H
#define FLUIDY_STYLE_STABILISE_H

#include "style/estimate.h"

/** The displacement of a frame's content from its position in the first frame, px, right and down.
 */
typedef struct FlShift {
    float x, y;
} FlShift;

/**
 * Finds the shift of every frame from the places that no mask ever covers: paper texture, pencil
 * marks, the sheet's edge. A shift that does not bring a frame clearly nearer to the first is 0.
 * `shift` has n_frames elements; the first is 0. Shakes of up to 8 px are found.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_shake_estimate(const FlClip *clip, const uint8_t *mask, FlShift *shift, GError **error);

/** The longest of the shifts, in either axis, px. */
float fl_shake_extent(const FlShift *shift, int n_frames);

/**
 * Moves a plane by -shift in place: `channels` interleaved bytes, cubic between pixels, the rim
 * repeated. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_shake_undo(uint8_t *plane, int width, int height, int channels, FlShift shift,
                   GError **error);

#endif
