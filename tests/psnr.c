/*
 * usage: psnr A.png B.png prints the PSNR of two pictures over grey in dB, 99 if they look the same
 * and 0 if their sizes differ by more than a pixel, to which pages are rounded; psnr A.png prints
 * its size as WIDTHxHEIGHT.
 */
#include "base/surface.h"
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define GREY 90 // backdrop: white on white would not be compared

/** The square of how far the colours of two premultiplied pixels are apart over grey. */
static double squares(uint32_t a, uint32_t b)
{
    double sum = 0;
    for (int shift = 0; shift < 24; shift += 8) {
        const double x = (a >> shift & 255) + GREY * (255.0 - (a >> 24)) / 255;
        const double y = (b >> shift & 255) + GREY * (255.0 - (b >> 24)) / 255;
        sum += (x - y) * (x - y);
    }
    return sum;
}

static double psnr(cairo_surface_t *a, cairo_surface_t *b)
{
    const int wide = cairo_image_surface_get_width(a) - cairo_image_surface_get_width(b);
    const int high = cairo_image_surface_get_height(a) - cairo_image_surface_get_height(b);
    const int width = cairo_image_surface_get_width(wide < 0 ? a : b);
    const int height = cairo_image_surface_get_height(high < 0 ? a : b);
    const size_t a_words = (size_t)cairo_image_surface_get_stride(a) / 4;
    const size_t b_words = (size_t)cairo_image_surface_get_stride(b) / 4;
    const uint32_t *of_a = (const uint32_t *)cairo_image_surface_get_data(a);
    const uint32_t *of_b = (const uint32_t *)cairo_image_surface_get_data(b);
    const bool a_opaque = cairo_image_surface_get_format(a) == CAIRO_FORMAT_RGB24;
    const bool b_opaque = cairo_image_surface_get_format(b) == CAIRO_FORMAT_RGB24;
    if (abs(wide) > 1 || abs(high) > 1)
        return 0;
    double sum = 0;
    for (size_t y = 0; y < (size_t)height; y++)
        for (size_t x = 0; x < (size_t)width; x++)
            sum += squares(of_a[y * a_words + x] | (a_opaque ? 0xff000000 : 0),
                           of_b[y * b_words + x] | (b_opaque ? 0xff000000 : 0));
    const double mse = sum / (3.0 * width * height);
    return mse > 0 ? MIN(99, 10 * log10(255 * 255 / mse)) : 99;
}

int main(int argc, char **argv)
{
    g_autoptr(cairo_surface_t) a = argc > 1 ? cairo_image_surface_create_from_png(argv[1]) : NULL;
    g_autoptr(cairo_surface_t) b = argc > 2 ? cairo_image_surface_create_from_png(argv[2]) : NULL;
    if (!a || cairo_surface_status(a) || (b && cairo_surface_status(b)))
        return 1;
    if (b)
        printf("%.1f\n", psnr(a, b));
    else
        printf("%dx%d\n", cairo_image_surface_get_width(a), cairo_image_surface_get_height(a));
    return 0;
}
