/* PNG files as small as libpng makes them; nothing in them depends on the day or the machine. */
#include "watercolour/scan.h"

#include <errno.h>
#include <glib/gstdio.h>
#include <png.h>
#include <stdio.h>

static void on_error(png_structp png, png_const_charp message)
{
    g_strlcpy(png_get_error_ptr(png), message, 80);
    png_longjmp(png, 1);
}

static void on_warning(png_structp png, png_const_charp message)
{
}

static void write_rows(png_structp png, const uint8_t *samples, int height, size_t row_bytes)
{
    for (int y = 0; y < height; y++)
        png_write_row(png, samples + (size_t)y * row_bytes);
}

/* Everything that may longjmp out of libpng; nothing is allocated here. */
static bool encode(png_structp png, png_infop info, FILE *file, const uint8_t *samples, int width,
                   int height, int channels)
{
    if (setjmp(png_jmpbuf(png)))
        return false;
    png_init_io(png, file);
    png_set_IHDR(png, info, (unsigned)width, (unsigned)height, 8,
                 channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    png_set_compression_level(png, 9);
    png_set_filter(png, PNG_FILTER_TYPE_BASE, PNG_ALL_FILTERS);
    png_write_info(png, info);
    write_rows(png, samples, height, (size_t)width * channels);
    png_write_end(png, info);
    return fflush(file) == 0;
}

static bool encode_file(const char *path, const uint8_t *samples, int width, int height,
                        int channels, char message[80])
{
    FILE *file = g_fopen(path, "wb");
    if (!file) {
        g_strlcpy(message, g_strerror(errno), 80);
        return false;
    }
    png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, message, on_error, on_warning);
    png_infop info = png ? png_create_info_struct(png) : NULL;
    const bool done = info && encode(png, info, file, samples, width, height, channels);
    png_destroy_write_struct(&png, &info);
    return fclose(file) == 0 && done;
}

bool fl_scan_write_png(const char *path, const uint8_t *samples, int width, int height,
                       int channels, GError **error)
{
    g_autofree char *part = g_strconcat(path, ".part", NULL);
    char message[80] = "";
    if (encode_file(part, samples, width, height, channels, message) && g_rename(part, path) == 0)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                message[0] ? message : g_strerror(errno));
    g_unlink(part);
    return false;
}
