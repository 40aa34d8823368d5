/* How near a film's regions, laid over each other without paint, come to librsvg's own picture. */
#ifndef FLUIDY_TESTS_FLAT_H
#define FLUIDY_TESTS_FLAT_H

#include "base/surface.h"
#include "drawing/drawing.h"
#include <math.h>

/** librsvg's picture of a file as it is, in the frame's size, as premultiplied ARGB. */
static inline cairo_surface_t *flat_truth(const FlDrawing *drawing, int frame)
{
    GError *error = NULL;
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autoptr(RsvgHandle) svg = rsvg_handle_new_from_file(fl_drawing_file(drawing, frame), &error);
    g_assert_no_error(error);
    rsvg_handle_set_dpi(svg, 96);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
    g_autoptr(cairo_t) cr = cairo_create(surface);
    RsvgRectangle page = {0, 0, width, height};
    double w, h;
    if (rsvg_handle_get_intrinsic_size_in_pixels(svg, &w, &h))
        page.width = w, page.height = h;
    rsvg_handle_render_document(svg, cr, &page, &error);
    g_assert_no_error(error);
    cairo_surface_flush(surface);
    return surface;
}

#define FLAT_GREY 90 // backdrop: white on white would not be compared

/** PSNR in dB of RGB over grey; 99 if nothing differs. */
static inline double flat_psnr(const FlDrawing *drawing, int frame)
{
    GError *error = NULL;
    const int width = fl_drawing_width(drawing), height = fl_drawing_height(drawing);
    g_autoptr(cairo_surface_t) truth = flat_truth(drawing, frame);
    g_autoptr(FlDrawList) draws = fl_drawing_draw_list(drawing, frame, &error);
    g_assert_no_error(error);
    g_autofree uint8_t *flat = g_malloc(4 * (size_t)width * height);
    fl_draw_list_flat(draws, width, height, flat);
    const unsigned char *rows = cairo_image_surface_get_data(truth);
    const int stride = cairo_image_surface_get_stride(truth);
    double sum = 0;
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            const uint32_t pixel = ((const uint32_t *)(rows + (size_t)y * stride))[x];
            const uint8_t *mine = flat + 4 * ((size_t)y * width + x);
            for (int c = 0; c < 3; c++) {
                const double a = mine[3] / 255.0, b = (pixel >> 24) / 255.0;
                const double theirs = (pixel >> (16 - 8 * c) & 255) + FLAT_GREY * (1 - b);
                const double d = mine[c] * a + FLAT_GREY * (1 - a) - theirs;
                sum += d * d;
            }
        }
    const double mse = sum / (3.0 * width * height);
    return mse > 0 ? MIN(99, 10 * log10(255 * 255 / mse)) : 99;
}

#endif
