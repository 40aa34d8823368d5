/* The masks of every region and frame, compressed in a temporary file. */
#pragma once

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

typedef struct FlMaskStore FlMaskStore;

/** For frames of width * height. Returns: NULL with FL_ERROR_OUTPUT set. */
FlMaskStore *fl_mask_store_new(int n_regions, int n_frames, int width, int height, GError **error);
void fl_mask_store_free(FlMaskStore *masks); // NULL is fine

/** Stores a mask of width * height bytes. Any thread. */
bool fl_mask_store_put(FlMaskStore *masks, int region, int frame, const uint8_t *coverage,
                       GError **error);

/** The same of a mask that is 0 beyond `part`. */
bool fl_mask_store_put_part(FlMaskStore *masks, int region, int frame, const uint8_t *coverage,
                            FlRect part, GError **error);

/** Reads `part` of a mask, part.width * part.height bytes; all 0 if no mask was stored. */
bool fl_mask_store_get(const FlMaskStore *masks, int region, int frame, FlRect part,
                       uint8_t *coverage, GError **error);

/** A mask of width * height in the size of fl_half_side(): the mean of 2x2 coverages, those of the
 * last column and row again where there are no more. A pixel is inside if one of its four is, so
 * that thin parts are not lost. half may be the mask. */
void fl_mask_halve(const uint8_t *mask, int width, int height, uint8_t *half);

/** The same in half the size, fl_rect_halved(part), by fl_mask_halve(). */
bool fl_mask_store_get_half(const FlMaskStore *masks, int region, int frame, FlRect part,
                            uint8_t *coverage, GError **error);

/** The rectangle around a mask; {0, 0, 0, 0} if it is blank. */
FlRect fl_mask_store_box(const FlMaskStore *masks, int region, int frame);

/** Returns: true if a mask was stored that has some coverage. */
bool fl_mask_store_has(const FlMaskStore *masks, int region, int frame);

/** Returns: true if a region has the same mask in two frames: one box and one CRC. */
bool fl_mask_store_same(const FlMaskStore *masks, int region, int a, int b);

/** The rectangle around a region in all frames; {0, 0, 0, 0} if no frame has it. */
FlRect fl_mask_store_extent(const FlMaskStore *masks, int region);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlMaskStore, fl_mask_store_free)
