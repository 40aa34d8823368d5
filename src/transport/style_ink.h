/* The ink of a style, the goal of the transport. */
#ifndef FLUIDY_TRANSPORT_STYLE_INK_H
#define FLUIDY_TRANSPORT_STYLE_INK_H

#include "style/style_folder.h"
#include "transport/sliced.h"

/**
 * The ink of a style's first frame, by the sum of its channels' optical densities: width * height,
 * of mean 1. Returns: to be freed with free(); NULL with FL_ERROR_STYLE or FL_ERROR_NO_MEMORY.
 */
float *fl_style_ink(const FlStyle *style, GError **error);

/** The patches of a folder's ink, px of its pictures. FL_ERROR_STYLE or FL_ERROR_NO_MEMORY. */
FlSliced *fl_style_patches(const char *folder, GError **error);

#endif
