#include "worker/raster.h"

#include <string.h>

static int pixel_bytes(cairo_surface_t *surface)
{
    return cairo_image_surface_get_format(surface) == CAIRO_FORMAT_A8 ? 1 : 4;
}

void fl_surface_wipe(cairo_surface_t *surface, FlRect box)
{
    const int stride = cairo_image_surface_get_stride(surface), size = pixel_bytes(surface);
    cairo_surface_flush(surface);
    unsigned char *data = cairo_image_surface_get_data(surface);
    for (int y = box.y; y < box.y + box.height; y++)
        memset(data + (size_t)y * stride + box.x * size, 0, (size_t)box.width * size);
    cairo_surface_mark_dirty(surface);
}

FlRect fl_surface_bounds(cairo_surface_t *surface, FlRect box)
{
    const int stride = cairo_image_surface_get_stride(surface), size = pixel_bytes(surface);
    cairo_surface_flush(surface);
    const FlRect bytes = {box.x * size, box.y, box.width * size, box.height};
    const FlRect ink = fl_rect_within(cairo_image_surface_get_data(surface), stride, bytes);
    return fl_rect_between(ink.x / size, ink.y, (ink.x + ink.width + size - 1) / size,
                           ink.y + ink.height);
}
