/* WebP images in drawings, for which librsvg seldom has a decoder. */
#pragma once

#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

/** Reads the size from a header. Returns: false for what is no WebP image, or without libwebp. */
bool fl_webp_size(const uint8_t *data, size_t bytes, int size[2]);

/** The image as the data URI of a PNG; NULL: it is damaged, or an animation. */
char *fl_webp_as_png(const uint8_t *data, size_t bytes);
