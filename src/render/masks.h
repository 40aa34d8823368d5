/* The masks of every region and frame, kept small in a temporary file. */
#ifndef FLUIDY_RENDER_MASKS_H
#define FLUIDY_RENDER_MASKS_H

#include "base/box.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct FlMasks FlMasks;

/** For frames of width * height. Returns: NULL with FL_ERROR_OUTPUT set. */
FlMasks *fl_masks_new(int n_regions, int n_frames, int width, int height, GError **error);
void fl_masks_free(FlMasks *masks); // NULL is fine

/** Keeps a mask of width * height bytes. Any thread. */
bool fl_masks_put(FlMasks *masks, int region, int frame, const uint8_t *coverage, GError **error);

/** Reads the part of a mask that lies in `part`, part.width * part.height bytes; 0 if none was put.
 */
bool fl_masks_get(const FlMasks *masks, int region, int frame, FlBox part, uint8_t *coverage,
                  GError **error);

/** Where a region ever is. Returns: {0, 0, 0, 0} if nowhere. */
FlBox fl_masks_extent(const FlMasks *masks, int region);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlMasks, fl_masks_free)

#endif
