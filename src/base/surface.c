#include "base/surface.h"

#include "base/alloc.h"
#include "base/error.h"
#include <string.h>

#define MAX_SIDE 32767 // px; cairo's limit

cairo_surface_t *fl_surface_new(cairo_format_t format, int width, int height, GError **error)
{
    if (width < 1 || height < 1 || width > MAX_SIDE || height > MAX_SIDE)
        return fl_none(error, FL_ERROR_LIMIT,
                       "a picture of %dx%d pixels; expected 1 to %d on each side", width, height,
                       MAX_SIDE);
    g_autoptr(cairo_surface_t) surface = cairo_image_surface_create(format, width, height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return fl_none(error, FL_ERROR_NO_MEMORY, "a picture of %dx%d pixels: %s", width, height,
                       cairo_status_to_string(cairo_surface_status(surface)));
    return g_steal_pointer(&surface);
}

cairo_surface_t *fl_surface_of(const uint8_t *pixels, int channels, int width, int height,
                               GError **error)
{
    cairo_surface_t *surface = fl_surface_new(CAIRO_FORMAT_ARGB32, width, height, error);
    if (!surface)
        return NULL;
    unsigned char *row = cairo_image_surface_get_data(surface);
    for (int y = 0; y < height; y++, row += cairo_image_surface_get_stride(surface))
        for (int x = 0; x < width; x++, pixels += channels) {
            const uint32_t alpha = channels == 4 ? pixels[3] : 255;
            uint32_t pixel = alpha;
            for (int c = 0; c < 3; c++)
                pixel = pixel << 8 | (pixels[c] * alpha + 127) / 255;
            memcpy(row + 4 * (size_t)x, &pixel, 4);
        }
    cairo_surface_mark_dirty(surface);
    return surface;
}

uint8_t *fl_surface_bytes(cairo_surface_t *surface, int channels, int height, GError **error)
{
    const int width = cairo_image_surface_get_width(surface);
    uint8_t *pixels = fl_alloc((size_t)width * height, (size_t)channels, "a picture", error);
    if (!pixels)
        return NULL;
    cairo_surface_flush(surface);
    const unsigned char *row = cairo_image_surface_get_data(surface);
    uint8_t *to = pixels;
    for (int y = 0; y < height; y++, row += cairo_image_surface_get_stride(surface))
        for (int x = 0; x < width; x++, to += channels) {
            uint32_t pixel;
            memcpy(&pixel, row + 4 * (size_t)x, 4);
            for (int c = 0; c < channels; c++)
                to[c] = c < 3 ? pixel >> (16 - 8 * c) & 255 : 255;
        }
    return pixels;
}
