#include "drawing/raster.h"

#include "base/rect.h"
#include <string.h>

static int pixel_bytes(cairo_surface_t *surface)
{
    return cairo_image_surface_get_format(surface) == CAIRO_FORMAT_A8 ? 1 : 4;
}

void fl_surface_wipe(cairo_surface_t *surface, FlBounds box)
{
    const int stride = cairo_image_surface_get_stride(surface), size = pixel_bytes(surface);
    cairo_surface_flush(surface);
    unsigned char *data = cairo_image_surface_get_data(surface);
    for (int y = box.y0; y < box.y1; y++)
        memset(data + (size_t)y * stride + box.x0 * size, 0, (size_t)(box.x1 - box.x0) * size);
    cairo_surface_mark_dirty(surface);
}

/** The first (step 1) or last (step -1) byte of n that is not 0; n if none. */
static int find_ink(const unsigned char *row, int n, int step)
{
    for (int i = step > 0 ? 0 : n - 1; i >= 0 && i < n; i += step)
        if (row[i])
            return i;
    return n;
}

FlBounds fl_surface_ink(cairo_surface_t *surface, FlBounds box)
{
    const int stride = cairo_image_surface_get_stride(surface), size = pixel_bytes(surface);
    cairo_surface_flush(surface);
    const unsigned char *data = cairo_image_surface_get_data(surface);
    FlBounds ink = {box.x1, box.y1, box.x0, box.y0};
    const int n = (box.x1 - box.x0) * size;
    for (int y = box.y0; y < box.y1 && n > 0; y++) {
        const unsigned char *row = data + (size_t)y * stride + box.x0 * size;
        if (fl_is_blank(row, (size_t)n))
            continue;
        ink.y0 = ink.y0 < y ? ink.y0 : y;
        ink.y1 = y + 1;
        const int first = box.x0 + find_ink(row, n, 1) / size;
        const int last = box.x0 + find_ink(row, n, -1) / size + 1;
        ink.x0 = ink.x0 < first ? ink.x0 : first;
        ink.x1 = ink.x1 > last ? ink.x1 : last;
    }
    return ink.y1 > ink.y0 ? ink : (FlBounds){0};
}

FlBounds fl_bounds_and(FlBounds a, FlBounds b)
{
    const FlBounds both = {a.x0 > b.x0 ? a.x0 : b.x0, a.y0 > b.y0 ? a.y0 : b.y0,
                           a.x1 < b.x1 ? a.x1 : b.x1, a.y1 < b.y1 ? a.y1 : b.y1};
    return both.x1 > both.x0 && both.y1 > both.y0 ? both : (FlBounds){0};
}

FlBounds fl_bounds_or(FlBounds a, FlBounds b)
{
    if (a.x1 <= a.x0 || b.x1 <= b.x0)
        return a.x1 <= a.x0 ? b : a;
    return (FlBounds){a.x0 < b.x0 ? a.x0 : b.x0, a.y0 < b.y0 ? a.y0 : b.y0,
                      a.x1 > b.x1 ? a.x1 : b.x1, a.y1 > b.y1 ? a.y1 : b.y1};
}

bool fl_bounds_meet(FlBounds a, FlBounds b)
{
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}
