/* PNG files in and out. */
#pragma once

#include "base/picture.h"
#include "base/pixel_runs.h"
#include "io/atomic_file.h"
#include <stdbool.h>

/** A picture to be written as PNG; one of rgba, runs and rgba16 is set. */
typedef struct FlPng {
    int width, height;       // pixels, >= 1
    const uint8_t *rgba;     // width * height * 4 straight sRGBA, 8 bits a channel
    const FlPixelRuns *runs; // the same as runs
    const FlRect *filled;    // the part that rgba or runs cover; the rest is transparent; NULL: all
    const uint16_t *rgba16;  // the same, 16 bits, native byte order
    bool opaque;             // store no alpha; not with runs or filled
    bool fast;               // deflate at level 1 instead of 4
    const FlRect *place;     // its place in a larger picture, from 0; may be NULL
    const char *const *text; // keyword, text, …, NULL; or NULL
    const char *mark;        // see fl_mark_text(); of files only; or NULL
} FlPng;

/**
 * Writes a file, whole or not at all, making its folder.
 *
 * Returns: false with FL_ERROR_OUTPUT, or FL_ERROR_EXISTS if it exists and overwrite is false.
 */
bool fl_png_save(const FlPng *png, const char *path, bool overwrite, GError **error);

/** Writes the bytes of the file, which is open. FL_ERROR_OUTPUT. */
bool fl_png_put(const FlPng *png, FlAtomicFile *file, GError **error);

/** Checks that a name ends in .png; else FL_ERROR_USAGE: `what`, such as "maps are", PNG files. */
bool fl_png_named(const char *path, const char *what, GError **error);

/** The bytes of the file that fl_png_save() writes; NULL if memory is short. */
GBytes *fl_png_encode(const FlPng *png);

/**
 * Reads a PNG file of any kind: 8 or 16 bit, grey, palette, with or without alpha.
 *
 * Returns: NULL with FL_ERROR_INPUT or FL_ERROR_LIMIT set, naming the file.
 */
FlPicture *fl_picture_read_png(const char *path, GError **error);

/**
 * Reads the place of a PNG file in a larger picture: FlPng.place, with the file's own size. Reads
 * the head of the file alone. Returns: false if the file has no place or cannot be read.
 */
bool fl_png_place(const char *path, FlRect *place);

/** The text that a PNG file has before its pixels for a keyword, see FlPng.text; to be freed. NULL
 * if absent. */
char *fl_png_text(const char *path, const char *keyword);

/** Returns: true if every pixel of a PNG file is opaque, or if the file cannot be read. */
bool fl_picture_is_opaque(const char *path);

/**
 * Writes `channels` (1 grey, 3 sRGB, 4 sRGBA) interleaved bytes as a small PNG file, choosing
 * filters by row; replaces a file of that name. Returns: false with
 * FL_ERROR_OUTPUT set, naming the file.
 */
bool fl_png_write(const char *path, const uint8_t *data, int width, int height, int channels,
                  GError **error);
