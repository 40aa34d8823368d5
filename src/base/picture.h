/* Pictures in memory. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Straight sRGBA, 8 bits a channel, rows from the top without padding. */
typedef struct FlPicture {
    int width, height; // pixels, >= 1
    uint8_t *rgba;     // height * width * 4
} FlPicture;

/** Frames of one size, one after the other without padding: sRGB, 3 bytes a pixel. */
typedef struct FlClip {
    int width, height, n_frames; // each >= 1
    const uint8_t *rgb;
} FlClip;

/** A transparent black picture. Returns: NULL with FL_ERROR_NO_MEMORY, or FL_ERROR_LIMIT. */
FlPicture *fl_picture_new(int width, int height, GError **error);

void fl_picture_free(FlPicture *picture); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPicture, fl_picture_free)
