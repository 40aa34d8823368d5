/* Frames, alpha and masks of a style as pixels, while it is being made or read. */
#pragma once

#include "base/picture.h"
#include "style/style_folder.h"

/** Allocates n_frames frames of a picture's size. False: FL_ERROR_LIMIT or FL_ERROR_NO_MEMORY. */
bool fl_style_allocate(FlStyle *style, const FlPicture *first, int n_frames, GError **error);

/** Stores a frame: its colours in rgb, its alpha in mask. */
void fl_style_store_frame(FlStyle *style, int frame, const FlPicture *picture);

/** Returns: true if any pixel of mask, which holds the alpha at this stage, is not opaque. */
bool fl_style_has_alpha(const FlStyle *style);

/** Composites the colours, whose straight alpha is in mask, over the paper. */
void fl_style_composite(FlStyle *style);

/** Stores a mask: its lightness times its alpha. */
void fl_style_store_mask(FlStyle *style, int frame, const FlPicture *picture);

/** Returns: false with FL_ERROR_STYLE set if every mask is empty or covers only bare paper. */
bool fl_style_check_paint(const FlStyle *style, GError **error);
