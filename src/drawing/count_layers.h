/* How many frames one file holds as layers. */
#ifndef FLUIDY_DRAWING_COUNT_LAYERS_H
#define FLUIDY_DRAWING_COUNT_LAYERS_H

#include <fluidy/error.h>

/**
 * Counts the frames of fl_layer_frames_count() of a file, which a confined child process reads.
 *
 * Returns: 2 or more; 0 with FL_ERROR_INPUT or FL_ERROR_LIMIT set, also if there are fewer.
 */
int fl_count_layers(const char *file, GError **error);

#endif
