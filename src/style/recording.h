/* A recording to import: a video, a still, numbered pictures or a folder of them. */
#ifndef FLUIDY_STYLE_RECORDING_H
#define FLUIDY_STYLE_RECORDING_H

#include "io/picture_series.h"
#include <fluidy/style.h>

typedef struct FlRecording {
    char *path;        // as given by the user
    FlSeries *series;  // numbered pictures, or one still; NULL: a video
    int number;        // of the first frame that was read
    int width, height; // of the frames that were read, before crop and scale
} FlRecording;

/**
 * Finds out what `path` is; reads no picture yet. In a folder, *masks is a second series called
 * mask..., or the folder `masks` beside `frames`, also to be freed; else NULL. With masks == NULL,
 * the result is the series of masks of such a folder.
 *
 * Returns: NULL with FL_ERROR_INPUT set if there is no picture, or more than one series.
 */
FlRecording *fl_recording_open(const char *path, FlRecording **masks, GError **error);

void fl_recording_free(FlRecording *source); // NULL is fine

/**
 * Reads the frames that `how` selects, crops and scales them; all have one size, and together at
 * most FL_LIMIT_STYLE.
 *
 * Returns: (element-type FlPicture); NULL with FL_ERROR_INPUT, _USAGE or _LIMIT set.
 */
GPtrArray *fl_recording_read(FlRecording *source, const FlStyleImport *import, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlRecording, fl_recording_free)

#endif
