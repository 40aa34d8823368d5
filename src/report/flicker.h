/* How much paint changes from frame to frame where it stays inside its region. */
#ifndef FLUIDY_REPORT_FLICKER_H
#define FLUIDY_REPORT_FLICKER_H

#include "render/painter.h"

/** What a painter's last frame was like. */
typedef struct FlFlicker {
    uint8_t *luma, *mask; // rect.width * rect.height of the painter; NULL: no frame yet
} FlFlicker;

void fl_flicker_clear(FlFlicker *flicker);

/**
 * Compares the painter's last picture, which is of `frame`, with the one before, in the style's own
 * colours.
 *
 * `change` becomes the mean absolute difference of luma, in levels of 255, over the pixels that lie
 * in the region in both frames; NAN if there are none.
 */
bool fl_flicker_measure(FlFlicker *flicker, const FlPainter *painter, int frame, double *change,
                        GError **error);

/** The same of the exemplar itself: mean over its frames; NAN if it has one only. */
double fl_flicker_of_exemplar(const FlExemplar *exemplar);

#endif
