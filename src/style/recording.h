/* A recording to import: a video, a still, numbered pictures or a folder of them; and its shake. */
#pragma once

#include "base/picture.h"
#include "io/picture_series.h"
#include "style/estimate.h"
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

/* ---- shake ----------------------------------------------------------------------------------- */

/** The displacement of a frame's content from its position in the first frame, px, right and down.
 */
typedef struct FlShift {
    float x, y;
} FlShift;

/**
 * Finds the shift of every frame from the places that no mask ever covers: paper texture, pencil
 * marks, the sheet's edge. A shift that does not bring a frame clearly nearer to the first is 0.
 * `shift` has n_frames elements; the first is 0. Shakes of up to 8 px are found.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_shake_estimate(const FlClip *clip, const uint8_t *mask, FlShift *shift, GError **error);

/** The longest of the shifts, in either axis, px. */
float fl_shake_extent(const FlShift *shift, int n_frames);

/**
 * Moves a plane by -shift in place: `channels` interleaved bytes, cubic between pixels, the rim
 * repeated. Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_shake_undo(uint8_t *plane, int width, int height, int channels, FlShift shift,
                   GError **error);
