/* The part of a style that is used, at the size that suits the target. */
#pragma once

#include "style/style_folder.h"

/** Selects frames of a style and their size. */
typedef struct FlStyleUse {
    int start;    // first frame, from 1
    int frames;   // maximal number; 0: all
    int step;     // every step-th frame, >= 1
    float scale;  // size factor; 0: the style's own
    bool reverse; // the last frame first
} FlStyleUse;

/**
 * Copies the used part at its new size. The border width scales with the pictures, flow with size
 * and step. A cut-out gets bare paper around it, so that the exemplar has its whole rim, unless it
 * fills its frames.
 *
 * Returns: to be freed with fl_style_free(); NULL with FL_ERROR_USAGE if no frame is left or the
 * pictures would be smaller than a patch, or FL_ERROR_NO_MEMORY.
 */
FlStyle *fl_style_adapt(const FlStyle *style, const FlStyleUse *use, GError **error);

/** A style of half the size, fl_half_side(): means of 2x2 pixels. FL_ERROR_NO_MEMORY. */
FlStyle *fl_style_halve(const FlStyle *style, GError **error);
