/* PNG files. */
#ifndef FLUIDY_IO_PNG_H
#define FLUIDY_IO_PNG_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** A picture to be written as PNG; one of rgba and rgba16 is set. */
typedef struct FlPng {
    int width, height;       // pixels, >= 1
    const uint8_t *rgba;     // width * height * 4 straight sRGBA, 8 bits a channel
    const uint16_t *rgba16;  // the same, 16 bits, native byte order
    bool opaque;             // store no alpha
    bool fast;               // deflate at level 1 instead of 4
    const char *const *text; // keyword, text, …, NULL; or NULL
} FlPng;

/**
 * Writes a file, whole or not at all, making its folder.
 *
 * Returns: false with FL_ERROR_OUTPUT, or FL_ERROR_EXISTS if it exists and overwrite is false.
 */
bool fl_png_save(const FlPng *png, const char *path, bool overwrite, GError **error);

/** Whether a name ends in .png; else FL_ERROR_USAGE says that `what`, "maps are", PNG files. */
bool fl_png_named(const char *path, const char *what, GError **error);

/** The bytes of the file that fl_png_save() writes; NULL if memory is short. */
GBytes *fl_png_encode(const FlPng *png);

#endif
