/* Styles at the size at which they are wanted: made from their recipes where that is larger. */
#ifndef FLUIDY_JOB_STYLE_SIZE_H
#define FLUIDY_JOB_STYLE_SIZE_H

#include "base/error.h"
#include "style/style_folder.h"

/**
 * Reads a style for frames that are scale * texture_px times as large as its pictures; scale 0: the
 * factor that the style suggests. A small page, of texture_px below 1, leaves the frames' shorter
 * side at least_px, or at its own size.
 *
 * For a factor above 1, a style with a recipe is simulated at 2 or 4 times its size. The result is
 * kept in the user's cache folder, under a name made of recipe, size and version, and is made once
 * even by two processes. makes: false in a dry run, which does not simulate.
 *
 * *factor becomes the factor by which the frames still have to be scaled; it is above 1 only if no
 * larger pictures can be made.
 * Returns: to be freed with fl_style_free(); NULL with an error of fl_style_load(), of the recipe,
 * or FL_ERROR_INTERRUPTED set.
 */
FlStyle *fl_style_load_for(const char *folder, float scale, float texture_px, float least_px,
                           bool makes, FlCaller caller, float *factor, GError **error);

#endif
