/* The masks of every region and frame, kept small in a temporary file. */
#ifndef FLUIDY_RENDER_MASKS_H
#define FLUIDY_RENDER_MASKS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct FlMasks FlMasks;

/** For frames of width * height. Returns: NULL with FL_ERROR_OUTPUT set. */
FlMasks *fl_masks_new(int n_regions, int n_frames, int width, int height, GError **error);
void fl_masks_free(FlMasks *masks); // NULL is fine

/** Keeps a mask of width * height bytes. Any thread. */
bool fl_masks_put(FlMasks *masks, int region, int frame, const uint8_t *coverage, GError **error);

/** Reads a mask back, an empty one if none was put. */
bool fl_masks_get(const FlMasks *masks, int region, int frame, uint8_t *coverage, GError **error);

/** Whether the region has any coverage in the frame. */
bool fl_masks_present(const FlMasks *masks, int region, int frame);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlMasks, fl_masks_free)

#endif
