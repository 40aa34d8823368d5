#include "io/picture.h"

#include "base/alloc.h"
#include "base/limits.h"

#include <errno.h>
#include <math.h>
#include <png.h>
#include <stdio.h>
#include <string.h>

FlPicture *fl_picture_new(int width, int height, GError **error)
{
    g_autofree char *where = g_strdup_printf("a picture of %dx%d pixels", width, height);
    if (width < 1 || height < 1) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: expected 1 or more", where);
        return NULL;
    }
    if (!fl_limit_check(FL_LIMIT_IMAGE, (double)width * height / 1e6, where, error))
        return NULL;
    uint8_t *rgba = fl_alloc((size_t)width * height, 4, "a picture", error);
    if (!rgba)
        return NULL;
    FlPicture *picture = g_new(FlPicture, 1);
    *picture = (FlPicture){width, height, rgba};
    return picture;
}

void fl_picture_free(FlPicture *picture)
{
    if (!picture)
        return;
    free(picture->rgba);
    g_free(picture);
}

FlPicture *fl_picture_read_png(const char *path, GError **error)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    if (!png_image_begin_read_from_file(&png, path)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be read as a PNG picture: %s",
                    path, png.message);
        return NULL;
    }
    png.format = PNG_FORMAT_RGBA;
    png.flags |= PNG_IMAGE_FLAG_16BIT_sRGB; // else 16-bit files without gAMA count as linear
    g_autoptr(FlPicture) picture = png.width > INT32_MAX || png.height > INT32_MAX
                                       ? NULL
                                       : fl_picture_new((int)png.width, (int)png.height, error);
    if (!picture)
        g_prefix_error(error, "%s: ", path);
    else if (!png_image_finish_read(&png, NULL, picture->rgba, 0, NULL)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: a damaged PNG picture: %s", path,
                    png.message);
        g_clear_pointer(&picture, fl_picture_free);
    }
    png_image_free(&png);
    return g_steal_pointer(&picture);
}

bool fl_picture_is_opaque(const char *path)
{
    png_image png = {.version = PNG_IMAGE_VERSION};
    const bool known = png_image_begin_read_from_file(&png, path) != 0;
    const bool may_be_transparent = known && (png.format & PNG_FORMAT_FLAG_ALPHA) != 0;
    png_image_free(&png);
    g_autoptr(FlPicture) picture = may_be_transparent ? fl_picture_read_png(path, NULL) : NULL;
    const size_t pixels = picture ? (size_t)picture->width * picture->height : 0;
    for (size_t p = 0; p < pixels; p++)
        if (picture->rgba[4 * p + 3] < 255)
            return false;
    return true;
}

bool fl_png_write(const char *path, const uint8_t *data, int width, int height, int channels,
                  GError **error)
{
    const png_uint_32 formats[] = {0, PNG_FORMAT_GRAY, 0, PNG_FORMAT_RGB, PNG_FORMAT_RGBA};
    png_image png = {.version = PNG_IMAGE_VERSION,
                     .width = (png_uint_32)width,
                     .height = (png_uint_32)height,
                     .format = formats[channels]};
    // Filters and level as the library's own default: the file is written once and kept.
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(png);
    g_autofree uint8_t *file = g_try_malloc(bytes);
    if (!file || !png_image_write_to_memory(&png, file, &bytes, 0, data, 0, NULL)) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot make the PNG picture: %s", path,
                    file ? png.message : "not enough memory");
        return false;
    }
    g_autoptr(GError) below = NULL;
    if (!g_file_set_contents_full(path, (const char *)file, (gssize)bytes,
                                  G_FILE_SET_CONTENTS_CONSISTENT | G_FILE_SET_CONTENTS_DURABLE,
                                  0644, &below)) {
        g_set_error(error, FL_ERROR, FL_ERROR_OUTPUT, "%s: cannot be written: %s", path,
                    below->message);
        return false;
    }
    return true;
}

FlPicture *fl_picture_crop(const FlPicture *picture, int x, int y, int width, int height,
                           GError **error)
{
    g_assert(x >= 0 && y >= 0 && width <= picture->width - x && height <= picture->height - y);
    g_autoptr(FlPicture) part = fl_picture_new(width, height, error);
    for (int row = 0; part && row < height; row++)
        memcpy(part->rgba + (size_t)row * width * 4,
               picture->rgba + ((size_t)(y + row) * picture->width + x) * 4, (size_t)width * 4);
    return g_steal_pointer(&part);
}

void fl_resample_line(const float *from, int from_n, size_t from_step, float *to, int to_n,
                      size_t to_step)
{
    const float ratio = (float)from_n / (float)to_n, radius = ratio > 1 ? ratio : 1;
    for (int i = 0; i < to_n; i++) {
        const float centre = ((float)i + 0.5f) * ratio - 0.5f;
        const int first = MAX(0, (int)ceilf(centre - radius));
        const int last = MIN(from_n - 1, (int)floorf(centre + radius));
        float sum = 0, weight = 0;
        for (int k = first; k <= last; k++) {
            const float w = radius - fabsf((float)k - centre);
            sum += w * from[k * from_step];
            weight += w;
        }
        to[i * to_step] = sum / weight;
    }
}

/* Colours are weighted by alpha, so that transparent pixels lend no colour. */
static void weigh_row(const uint8_t *rgba, int width, float *weighted)
{
    for (int x = 0; x < width; x++, rgba += 4, weighted += 4) {
        for (int c = 0; c < 3; c++)
            weighted[c] = (float)(rgba[c] * rgba[3]);
        weighted[3] = rgba[3];
    }
}

static void unweigh_row(const float *weighted, int width, uint8_t *rgba)
{
    for (int x = 0; x < width; x++, rgba += 4, weighted += 4) {
        for (int c = 0; c < 3; c++)
            rgba[c] = weighted[3] > 0 ? (uint8_t)(MIN(weighted[c] / weighted[3], 255) + 0.5f) : 0;
        rgba[3] = (uint8_t)(weighted[3] + 0.5f);
    }
}

FlPicture *fl_picture_resize(const FlPicture *picture, int width, int height, GError **error)
{
    const size_t from_row = 4 * (size_t)picture->width, row = 4 * (size_t)width;
    const int tallest = MAX(picture->height, height);
    g_autoptr(FlPicture) resized = fl_picture_new(width, height, error);
    g_autofree float *weighted =
        resized ? fl_alloc(from_row + 2 * row * tallest, sizeof(float), "a picture", error) : NULL;
    if (!weighted)
        return NULL;
    float *across = weighted + from_row, *both = across + row * tallest;
    for (int y = 0; y < picture->height; y++) {
        weigh_row(picture->rgba + y * from_row, picture->width, weighted);
        for (int c = 0; c < 4; c++)
            fl_resample_line(weighted + c, picture->width, 4, across + y * row + c, width, 4);
    }
    for (size_t k = 0; k < row; k++)
        fl_resample_line(across + k, picture->height, row, both + k, height, row);
    for (int y = 0; y < height; y++)
        unweigh_row(both + y * row, width, resized->rgba + y * row);
    return g_steal_pointer(&resized);
}
