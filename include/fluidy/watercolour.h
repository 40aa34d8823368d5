/** @file
 * Paint from first principles: a recipe becomes a style folder. Threads: any thread may simulate,
 * several at a time into folders of their own.
 */
#ifndef FLUIDY_WATERCOLOUR_H
#define FLUIDY_WATERCOLOUR_H

#include <fluidy/error.h>
#include <stdbool.h>

G_BEGIN_DECLS

/** Called after each frame is painted, from the caller's thread; frame counts from 1; false stops.
 */
typedef bool (*FlWatercolourProgress)(int frame, int n_frames, void *data);

/**
 * Simulates a recipe and writes the frames as a style: style.ini, frames/0001.png …,
 * masks/0001.png ….
 *
 * Makes the folder if it does not exist; other files in it stay. Writes all files after the last
 * frame; on failure it writes no file. The same recipe and size give the same bytes on any thread
 * count. progress may be NULL. size is 1, 2 or 4: how often the recipe's width and height; the
 * paint is the same, its finest grain is finer.
 *
 * Returns: false with FL_ERROR_INPUT (the recipe; its file and line are named), FL_ERROR_EXISTS if
 * there is a style in the folder and `overwrite` is false, FL_ERROR_LIMIT, FL_ERROR_NO_MEMORY,
 * FL_ERROR_INTERRUPTED or FL_ERROR_OUTPUT.
 */
FL_API bool fl_watercolour_simulate(const char *recipe_path, const char *folder, int size,
                                    bool overwrite, FlWatercolourProgress progress, void *data,
                                    GError **error);

G_END_DECLS

#endif
