#include "output/contact.h"

#include "base/alloc.h"
#include "output/png.h"
#include <string.h>

/* All in px. */
enum { GAP = 8, WORDS_WIDTH = 180, WORDS_HEIGHT = 22, LINE = 15 };

bool fl_contact_init(FlContact *contact, int columns, int rows, int cell_width, int cell_height,
                     GError **error)
{
    const int width = WORDS_WIDTH + columns * (cell_width + GAP) + GAP;
    const int height = WORDS_HEIGHT + rows * (cell_height + GAP) + GAP;
    *contact = (FlContact){cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, height), columns,
                           rows, cell_width, cell_height};
    const cairo_status_t status = cairo_surface_status(contact->surface);
    if (status != CAIRO_STATUS_SUCCESS) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT, "cannot draw a sheet of %dx%d pixels: %s",
                    width, height, cairo_status_to_string(status));
        return false;
    }
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    return true;
}

void fl_contact_clear(FlContact *contact)
{
    g_clear_pointer(&contact->surface, cairo_surface_destroy);
}

/* The upper left corner of a cell. */
static void move_to_cell(const FlContact *contact, cairo_t *cr, int column, int row)
{
    cairo_translate(cr, WORDS_WIDTH + GAP + column * (contact->cell_width + GAP),
                    WORDS_HEIGHT + GAP + row * (contact->cell_height + GAP));
}

/* Straight sRGBA as cairo's premultiplied ARGB. */
static cairo_surface_t *surface_of(const FlPicture *picture)
{
    cairo_surface_t *surface =
        cairo_image_surface_create(CAIRO_FORMAT_ARGB32, picture->width, picture->height);
    if (cairo_surface_status(surface) != CAIRO_STATUS_SUCCESS)
        return surface;
    uint8_t *rows = cairo_image_surface_get_data(surface);
    const int stride = cairo_image_surface_get_stride(surface);
    for (int y = 0; y < picture->height; y++)
        for (int x = 0; x < picture->width; x++) {
            const uint8_t *from = picture->rgba + 4 * ((size_t)y * picture->width + x);
            uint32_t pixel = from[3];
            for (int c = 0; c < 3; c++)
                pixel = pixel << 8 | (from[c] * from[3] + 127) / 255;
            memcpy(rows + (size_t)y * stride + 4 * (size_t)x, &pixel, 4);
        }
    cairo_surface_mark_dirty(surface);
    return surface;
}

void fl_contact_put(const FlContact *contact, int column, int row, const FlPicture *picture)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    g_autoptr(cairo_surface_t) surface = surface_of(picture);
    const double across = (double)contact->cell_width / picture->width;
    const double down = (double)contact->cell_height / picture->height;
    const double scale = MIN(MIN(across, down), 1);
    move_to_cell(contact, cr, column, row);
    cairo_translate(cr, (int)(contact->cell_width - scale * picture->width) / 2,
                    (int)(contact->cell_height - scale * picture->height) / 2);
    cairo_scale(cr, scale, scale);
    cairo_set_source_surface(cr, surface, 0, 0);
    cairo_paint(cr);
}

static void write_line(cairo_t *cr, double x, double y, bool bold, const char *text)
{
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, bold ? 14 : 11);
    cairo_set_source_rgb(cr, 0.15, 0.15, 0.15);
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, text);
}

void fl_contact_name_row(const FlContact *contact, int row, const char *name, const char *lines)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    g_auto(GStrv) line = g_strsplit(lines, "\n", -1);
    move_to_cell(contact, cr, 0, row);
    cairo_rectangle(cr, -WORDS_WIDTH, 0, WORDS_WIDTH, contact->cell_height);
    cairo_clip(cr);
    write_line(cr, -WORDS_WIDTH, LINE, true, name);
    for (int k = 0; line[k]; k++)
        write_line(cr, -WORDS_WIDTH, (k + 2) * LINE + 3, false, line[k]);
}

void fl_contact_name_column(const FlContact *contact, int column, const char *name)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    move_to_cell(contact, cr, column, 0);
    write_line(cr, 0, -GAP, false, name);
}

bool fl_contact_save(const FlContact *contact, const char *path, bool overwrite, GError **error)
{
    const int width = cairo_image_surface_get_width(contact->surface);
    const int height = cairo_image_surface_get_height(contact->surface);
    g_autofree uint8_t *rgba = fl_alloc((size_t)width * height, 4, "a sheet", error);
    if (!rgba)
        return false;
    cairo_surface_flush(contact->surface);
    const uint8_t *rows = cairo_image_surface_get_data(contact->surface);
    const int stride = cairo_image_surface_get_stride(contact->surface);
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint32_t pixel = 0;
            memcpy(&pixel, rows + (size_t)y * stride + 4 * (size_t)x, 4);
            uint8_t *to = rgba + 4 * ((size_t)y * width + x);
            to[0] = pixel >> 16 & 255, to[1] = pixel >> 8 & 255, to[2] = pixel & 255, to[3] = 255;
        }
    const FlPng png = {.width = width, .height = height, .rgba = rgba, .opaque = true};
    return fl_png_save(&png, path, overwrite, error);
}
