/* Cairo's image surfaces: making them, and copying bytes in and out. g_autoptr for the types of
 * cairo and librsvg. */
#pragma once

#include <cairo.h>
#include <fluidy/error.h>
#include <librsvg/rsvg.h>
#include <stdint.h>

/** A cleared image surface; NULL with FL_ERROR_LIMIT or FL_ERROR_NO_MEMORY. */
cairo_surface_t *fl_surface_new(cairo_format_t format, int width, int height, GError **error);

/**
 * An ARGB32 surface of width * height pixels, rows from the top without padding: sRGB if channels
 * is 3, straight sRGBA if it is 4. Errors as above.
 */
cairo_surface_t *fl_surface_of(const uint8_t *pixels, int channels, int width, int height,
                               GError **error);

/**
 * The other way: the first `height` rows of an RGB24 surface, to be freed. A fourth channel is 255.
 * NULL with FL_ERROR_NO_MEMORY.
 */
uint8_t *fl_surface_bytes(cairo_surface_t *surface, int channels, int height, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(cairo_t, cairo_destroy)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(RsvgHandle, g_object_unref)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(cairo_surface_t, cairo_surface_destroy)
