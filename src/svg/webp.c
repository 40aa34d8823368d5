#include "svg/webp.h"

#include "config.h"
#include <cairo.h>
#if HAVE_WEBP
#include <webp/decode.h>

bool fl_webp_size(const uint8_t *data, size_t bytes, int size[2])
{
    return WebPGetInfo(data, bytes, &size[0], &size[1]) != 0;
}

static bool decode(const uint8_t *data, size_t bytes, cairo_surface_t *surface)
{
    WebPDecoderConfig config;
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS || !WebPInitDecoderConfig(&config))
        return false;
    const int stride = cairo_image_surface_get_stride(surface);
    const bool little = G_BYTE_ORDER == G_LITTLE_ENDIAN;
    config.output.colorspace = little ? MODE_bgrA : MODE_Argb;
    config.output.is_external_memory = 1;
    config.output.u.RGBA = (WebPRGBABuffer){
        .rgba = cairo_image_surface_get_data(surface),
        .stride = stride,
        .size = (size_t)stride * (size_t)cairo_image_surface_get_height(surface),
    };
    const bool good = WebPDecode(data, bytes, &config) == VP8_STATUS_OK;
    cairo_surface_mark_dirty(surface);
    return good;
}

static cairo_status_t append(void *png, const unsigned char *data, unsigned bytes)
{
    g_byte_array_append(png, data, bytes);
    return CAIRO_STATUS_SUCCESS;
}

char *fl_webp_as_png(const uint8_t *data, size_t bytes)
{
    int size[2] = {0};
    if (!fl_webp_size(data, bytes, size))
        return NULL;
    g_autoptr(GByteArray) png = g_byte_array_new();
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, size[0], size[1]);
    const bool good =
        decode(data, bytes, surface) &&
        cairo_surface_write_to_png_stream(surface, append, png) == CAIRO_STATUS_SUCCESS;
    cairo_surface_destroy(surface);
    g_autofree char *text = good ? g_base64_encode(png->data, png->len) : NULL;
    return good ? g_strconcat("data:image/png;base64,", text, NULL) : NULL;
}

#else

bool fl_webp_size(const uint8_t *data, size_t bytes, int size[2])
{
    (void)data, (void)bytes, (void)size;
    return false;
}

char *fl_webp_as_png(const uint8_t *data, size_t bytes)
{
    (void)data, (void)bytes;
    return NULL;
}

#endif
