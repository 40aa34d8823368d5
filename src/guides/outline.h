/* A mask with the data that the flow needs, shared by frames with the same mask. */
#pragma once

#include "guides/connected_parts.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** A mask in a frame of frame_width * frame_height pixels. Reference-counted; any thread may. */
typedef struct FlOutline {
    int references;
    int frame_width, frame_height;
    bool empty;             // no pixel is inside; box may still hold faint ones
    FlRect box;             // of all pixels with coverage
    uint8_t *coverage;      // of the box
    FlConnectedParts parts; // of the box's pixels that are inside; none if empty
    float *distance;        // of the frame, fl_distance(); NULL if empty
    float *normal;          // of the box, fl_outline_normals(); NULL until then
} FlOutline;

/** Of a region in two frames, borrowed; NULL where they are not known. */
typedef struct FlOutlinePair {
    FlOutline *before, *now;
} FlOutlinePair;

/** mask: frame_width * frame_height coverages, copied. NULL with FL_ERROR_NO_MEMORY set. */
FlOutline *fl_outline_new(const uint8_t *mask, int frame_width, int frame_height, GError **error);

FlOutline *fl_outline_ref(FlOutline *outline); // NULL is fine, as for _unref
void fl_outline_unref(FlOutline *outline);

/** True if the outline is that of this mask. */
bool fl_outline_equal(const FlOutline *outline, const uint8_t *mask);

/** True if two outlines are those of the same mask. */
bool fl_outlines_alike(const FlOutline *one, const FlOutline *other);

/** True if a pixel of the frame is inside. */
bool fl_outline_contains(const FlOutline *outline, int x, int y);

/** True if a pixel is inside and one of its four neighbours in the frame is not. */
bool fl_outline_is_contour(const FlOutline *outline, int x, int y);

/**
 * Gradient of a distance field at a pixel, over 5x5 pixels: Sobel's operator of that size, so that
 * the stairs of a binary mask do not show. Length about 1 beside a straight contour, 0 on a medial
 * axis.
 */
void fl_distance_gradient(const float *distance, int width, int height, int x, int y,
                          float gradient[2]);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlOutline, fl_outline_unref)
