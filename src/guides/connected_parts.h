/* The connected parts of a mask. */
#ifndef FLUIDY_GUIDES_CONNECTED_PARTS_H
#define FLUIDY_GUIDES_CONNECTED_PARTS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** Which part each pixel belongs to; pixels that share a side belong together. */
typedef struct FlConnectedParts {
    int n_parts;
    int32_t *part; // 1 … n_parts in the order of their first pixel, 0 outside; width * height
} FlConnectedParts;

/** coverage: width * height, inside from FL_INSIDE on. FL_ERROR_NO_MEMORY. */
bool fl_connected_parts_init(FlConnectedParts *parts, const uint8_t *coverage, int width,
                             int height, GError **error);
void fl_connected_parts_clear(FlConnectedParts *parts);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlConnectedParts, fl_connected_parts_clear)

#endif
