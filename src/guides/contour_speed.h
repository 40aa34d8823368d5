/* The speed at which the contour of a region advances, which wets paint ahead of it and dries paint
 * behind. */
#ifndef FLUIDY_GUIDES_CONTOUR_SPEED_H
#define FLUIDY_GUIDES_CONTOUR_SPEED_H

#include "guides/outline.h"

#define FL_CONTOUR_UNITS 480 // of the page's larger side

/** A region in a frame and the one before. */
typedef struct FlContourStep {
    const FlOutline *before, *now; // of one frame size; before NULL or empty: the region was absent
    const int32_t *motion; // of the drawing, of now->box, FL_MOTION_ONE a px; NULL: no motion
    const float *last;     // the speed of the frame before, of the frame; NULL: 0
    float unit_px;         // fl_contour_px()
} FlContourStep;

/** The unit of a page. */
static inline float fl_contour_px(int page_width, int page_height)
{
    return (float)MAX(page_width, page_height) / FL_CONTOUR_UNITS;
}

/** The distance from an outline's box up to which there is a speed, in units. */
#define FL_CONTOUR_REACH 20

/** The rectangle of a frame that has a speed. */
FlRect fl_contour_rect(const FlOutline *outline, float unit_px);

/**
 * The normal velocity of the contour, px a frame, positive where it advances: that of the drawing's
 * own motion, and growth that it does not explain. Where the motion is unknown, growth is all; a
 * limb that moves farther than it is wide so has a side that advances and one that recedes.
 *
 * It is smoothed along the contour, where that faces the same way, and along time. Each pixel has
 * that of the contour next to it, on both sides up to FL_CONTOUR_REACH; others have 0, and all have
 * 0 if the region was absent before. speed: of the frame. *moves: true if a speed is not 0.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_contour_speed(const FlContourStep *step, float *speed, bool *moves, GError **error);

#endif
