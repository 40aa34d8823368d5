/* Frames, alpha and masks of a style as pixels, while it is being made or read. */
#ifndef FLUIDY_STYLE_PAINT_FRAMES_H
#define FLUIDY_STYLE_PAINT_FRAMES_H

#include "base/picture.h"
#include "style/style_folder.h"

/** Room for n_frames frames of a picture's size. NULL pixels before. False: _LIMIT or _NO_MEMORY.
 */
bool fl_style_allocate(FlStyle *style, const FlPicture *first, int n_frames, GError **error);

/** Takes a frame in: its colours into rgb, its alpha into mask. */
void fl_style_store_frame(FlStyle *style, int frame, const FlPicture *picture);

/** Whether any mask pixel, which is alpha so far, is not opaque. */
bool fl_style_has_alpha(const FlStyle *style);

/** Lays the colours, whose straight alpha is in the mask, over the paper. */
void fl_style_composite(FlStyle *style);

/** Takes a mask in: its lightness times its alpha. */
void fl_style_store_mask(FlStyle *style, int frame, const FlPicture *picture);

/**
 * False with FL_ERROR_STYLE set if no mask covers anything, or nothing but bare paper: neither can
 * paint.
 */
bool fl_style_check_paint(const FlStyle *style, GError **error);

#endif
