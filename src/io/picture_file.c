#include "io/picture_file.h"

#include "base/file.h"
#include "config.h"
#include "io/png.h"

#if HAVE_JPEG
#include <gdk-pixbuf/gdk-pixbuf.h>
#endif
#include <stdio.h>
#include <string.h>

bool fl_picture_named(const char *path)
{
    static const char *const ends[] = {".png", ".jpg", ".jpeg"};
    g_autofree char *lower = g_ascii_strdown(path, -1);
    for (size_t i = 0; i < G_N_ELEMENTS(ends); i++)
        if (g_str_has_suffix(lower, ends[i]))
            return true;
    return false;
}

static bool is_jpeg(const char *path)
{
    uint8_t start[3] = {0};
    FILE *file = fopen(path, "rb");
    const bool is = file && fread(start, 1, 3, file) == 3 && memcmp(start, "\xff\xd8\xff", 3) == 0;
    if (file)
        fclose(file);
    return is;
}

#if HAVE_JPEG

static void copy_rows(const GdkPixbuf *pixbuf, FlPicture *picture)
{
    const int channels = gdk_pixbuf_get_n_channels(pixbuf);
    for (int y = 0; y < picture->height; y++) {
        const uint8_t *row =
            gdk_pixbuf_read_pixels(pixbuf) + (size_t)y * (size_t)gdk_pixbuf_get_rowstride(pixbuf);
        uint8_t *to = picture->rgba + 4 * (size_t)y * (size_t)picture->width;
        for (int x = 0; x < picture->width; x++, row += channels, to += 4)
            memcpy(to, row, 3), to[3] = 255;
    }
}

/* No other of the library's formats, whatever the file's content. */
static GdkPixbuf *load(const char *path, GError **error)
{
    g_autofree char *data = NULL;
    gsize bytes = 0;
    if (!g_file_get_contents(path, &data, &bytes, error))
        return NULL;
    g_autoptr(GdkPixbufLoader) loader = gdk_pixbuf_loader_new_with_type("jpeg", error);
    if (!loader)
        return NULL;
    if (!gdk_pixbuf_loader_write(loader, (const guchar *)data, bytes, error)) {
        gdk_pixbuf_loader_close(loader, NULL);
        return NULL;
    }
    if (!gdk_pixbuf_loader_close(loader, error))
        return NULL;
    return gdk_pixbuf_apply_embedded_orientation(gdk_pixbuf_loader_get_pixbuf(loader));
}

static FlPicture *read_jpeg(const char *path, GError **error)
{
    g_autoptr(GError) reason = NULL;
    g_autoptr(FlPicture) picture = NULL;
    int width = 0, height = 0;
    if (!gdk_pixbuf_get_file_info(path, &width, &height) || width < 1 || height < 1) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: a damaged JPEG picture", path);
        return NULL;
    }
    if (!(picture = fl_picture_new(width, height, error))) { // before the library asks for as much
        g_prefix_error(error, "%s: ", path);
        return NULL;
    }
    g_autoptr(GdkPixbuf) pixbuf = load(path, &reason);
    if (!pixbuf) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: a damaged JPEG picture: %s", path,
                    reason ? reason->message : "it has no pixels");
        return NULL;
    }
    picture->width = gdk_pixbuf_get_width(pixbuf); // turned upright, as many pixels
    picture->height = gdk_pixbuf_get_height(pixbuf);
    if ((int64_t)picture->width * picture->height != (int64_t)width * height) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: a damaged JPEG picture", path);
        return NULL;
    }
    copy_rows(pixbuf, picture);
    return g_steal_pointer(&picture);
}

#else

static FlPicture *read_jpeg(const char *path, GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                "%s: this build reads no JPEG pictures; expected a PNG file", path);
    return NULL;
}

#endif

FlPicture *fl_picture_read(const char *path, GError **error)
{
    if (!fl_file_check(path, FL_ERROR_INPUT, error))
        return NULL;
    return is_jpeg(path) ? read_jpeg(path, error) : fl_picture_read_png(path, error);
}
