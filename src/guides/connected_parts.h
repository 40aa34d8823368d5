/* The connected parts of a plane. */
#pragma once

#include "base/rect.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** The connected parts of a mask; pixels that share a side are connected. */
typedef struct FlConnectedParts {
    int n_parts;
    int32_t *part;   // 1 … n_parts in the order of their first pixel, 0 outside; width * height
    uint32_t *size;  // pixels of each part; [0]: 0
    size_t n_pixels; // width * height
} FlConnectedParts;

/** The parts of the pixels from `least` to `most`; plane: width * height. FL_ERROR_NO_MEMORY. */
bool fl_connected_parts_init(FlConnectedParts *parts, const uint8_t *plane, int width, int height,
                             uint8_t least, uint8_t most, GError **error);

/** Sets the pixels of parts with fewer than n_pixels pixels to `value`. */
void fl_connected_parts_drop(const FlConnectedParts *parts, size_t n_pixels, uint8_t value,
                             uint8_t *plane);
void fl_connected_parts_clear(FlConnectedParts *parts);

/**
 * The boxes of the pixels of each label from 0 to most, in the coordinates of `plane`, the
 * rectangle that the labels cover; a label without pixels has an empty box. box: most + 1.
 */
void fl_boxes_of_labels(const int32_t *label, FlRect plane, int most, FlRect *box);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlConnectedParts, fl_connected_parts_clear)
