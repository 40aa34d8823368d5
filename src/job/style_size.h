/* Styles at the size at which they are wanted: made from their recipes where that is larger. */
#ifndef FLUIDY_JOB_STYLE_SIZE_H
#define FLUIDY_JOB_STYLE_SIZE_H

#include "style/style_folder.h"
#include <fluidy/render.h>

/**
 * Reads a style whose frames are to be used `scale` times as large as its pictures are (as large as
 * it suggests: 0), times texture_px, px per px in which that is given.
 *
 * Where that is larger than its pictures and the recipe lies beside them, the style is simulated at
 * 2 or 4 times its size, once: it is kept below the user's cache folder, under a name made of
 * recipe, size and version. Two processes make it once; where it cannot be kept, it is made anew.
 * A dry run makes nothing.
 *
 * *factor becomes what its frames are to be scaled by: above 1 only where there is no more of it.
 * Returns: to be freed with fl_style_free(); NULL with an error of fl_style_load(), of the recipe,
 * or FL_ERROR_INTERRUPTED set.
 */
FlStyle *fl_style_load_for(const char *folder, float scale, float texture_px,
                           const FlRenderOptions *options, float *factor, GError **error);

#endif
