/* The background below the paint: a colour, a picture, one per frame, or transparency. */
#pragma once

#include "base/picture.h"
#include "drawing/drawing.h"

typedef struct FlBackground {
    bool none;           // transparent
    uint8_t flat[3];     // unless it is absent or a pattern
    bool opaque;         // true if it is opaque in all frames
    const char *pattern; // of PNG files, or one file; borrowed; NULL: flat
    uint8_t paper[3];    // on which paint is thought to lie: flat, or the style's paper
} FlBackground;

/**
 * Reads "#rrggbb", "none", a PNG file or a pattern with a frame number; NULL: the paper.
 * FL_ERROR_USAGE.
 */
bool fl_background_init(FlBackground *background, const char *text, const uint8_t paper[3],
                        const FlDrawing *drawing, GError **error);

/**
 * The picture of a frame, in the frame's size; the background has a pattern.
 * Returns: to be freed with fl_picture_free(); NULL with an error that names the file.
 */
FlPicture *fl_background_picture(const FlBackground *background, const FlDrawing *drawing,
                                 int frame, int width, int height, GError **error);
