/* A picture in memory, and PNG files in and out. */
#ifndef FLUIDY_IO_PICTURE_H
#define FLUIDY_IO_PICTURE_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/** Straight sRGBA, 8 bits a channel, rows from the top without padding. */
typedef struct FlPicture {
    int width, height; // pixels, >= 1
    uint8_t *rgba;     // height * width * 4
} FlPicture;

/** A transparent black picture. Returns: NULL with FL_ERROR_NO_MEMORY, or FL_ERROR_LIMIT. */
FlPicture *fl_picture_new(int width, int height, GError **error);

/**
 * Reads a PNG file of any kind: 8 or 16 bit, grey, palette, with or without alpha.
 *
 * Returns: NULL with FL_ERROR_INPUT or FL_ERROR_LIMIT set, naming the file.
 */
FlPicture *fl_picture_read_png(const char *path, GError **error);

/** Whether a PNG file has no pixel that is even partly transparent; true if it cannot be read. */
bool fl_picture_is_opaque(const char *path);

/**
 * Writes `channels` (1 grey, 3 sRGB, 4 sRGBA) interleaved bytes as a PNG file: a temporary name
 * first, synced and renamed. Returns: false with FL_ERROR_OUTPUT set, naming the file.
 */
bool fl_png_write(const char *path, const uint8_t *data, int width, int height, int channels,
                  GError **error);

/** The part of a picture from column x, row y on; it must lie within the picture. */
FlPicture *fl_picture_crop(const FlPicture *picture, int x, int y, int width, int height,
                           GError **error);

/**
 * A line of from_n samples in to_n samples; samples lie `step` floats apart. Area means where the
 * line gets shorter, linear interpolation where it gets longer: in both cases a tent as wide as the
 * larger sample, cut off at the ends of the line.
 */
void fl_resample_line(const float *from, int from_n, size_t from_step, float *to, int to_n,
                      size_t to_step);

/** The picture in another size, resampled along both axes. */
FlPicture *fl_picture_resize(const FlPicture *picture, int width, int height, GError **error);

void fl_picture_free(FlPicture *picture); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlPicture, fl_picture_free)

#endif
