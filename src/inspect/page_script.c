#include "inspect/page_script.h"

#include "io/png.h"
#include <gio/gio.h>
#include <math.h>
#include <string.h>

#define MARK "<!-- the frames -->" // in page.html

/* Of glib-compile-resources. A static library has its file only for who calls it. */
GResource *fl_report_page_get_resource(void);

GBytes *fl_page_file(const char *name)
{
    g_autofree char *path = g_strdup_printf("/fluidy/report/%s", name);
    return g_resource_lookup_data(fl_report_page_get_resource(), path, 0, NULL);
}

GBytes *fl_page_part(FlPagePart part)
{
    g_autoptr(GBytes) page = fl_page_file("page.html");
    gsize n = 0;
    const char *text = g_bytes_get_data(page, &n);
    const char *mark = g_strstr_len(text, (gssize)n, MARK);
    const gsize head = (gsize)(mark - text), rest = head + strlen(MARK);
    return part == FL_PAGE_HEAD ? g_bytes_new_from_bytes(page, 0, head)
                                : g_bytes_new_from_bytes(page, rest, n - rest);
}

void fl_script_string(FILE *out, const char *text)
{
    if (!text) {
        fputs("null", out);
        return;
    }
    g_autofree char *valid = g_utf8_make_valid(text, -1);
    fputc('"', out);
    for (const char *at = valid; *at; at = g_utf8_next_char(at)) {
        const gunichar c = g_utf8_get_char(at);
        // "<" could begin "</script>", and U+2028 and U+2029 end a line of old JavaScript.
        if (c < 0x20 || strchr("\"\\<>&", (int)MIN(c, 0x7f)) || c == 0x2028 || c == 0x2029)
            fprintf(out, "\\u%04x", (unsigned)c);
        else
            fwrite(at, 1, (size_t)(g_utf8_next_char(at) - at), out);
    }
    fputc('"', out);
}

void fl_script_number(FILE *out, double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    fputs(isfinite(value) ? g_ascii_formatd(text, sizeof text, "%.6g", value) : "null", out);
}

void fl_script_colour(FILE *out, const uint8_t rgb[3])
{
    fprintf(out, "\"#%02x%02x%02x\"", rgb[0], rgb[1], rgb[2]);
}

bool fl_script_picture(FILE *out, const FlPicture *picture, bool opaque, GError **error)
{
    const FlPng png = {.width = picture->width,
                       .height = picture->height,
                       .rgba = picture->rgba,
                       .opaque = opaque};
    g_autoptr(GBytes) bytes = fl_png_encode(&png);
    if (!bytes) {
        g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for a picture");
        return false;
    }
    gsize n = 0;
    const guchar *data = g_bytes_get_data(bytes, &n);
    g_autofree char *text = g_base64_encode(data, n);
    fprintf(out, "\"data:image/png;base64,%s\"", text);
    return true;
}
