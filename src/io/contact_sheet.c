#include "io/contact_sheet.h"

#include "io/png.h"

#include <string.h>

/* All in px. */
enum { GAP = 8, WORDS_WIDTH = 180, WORDS_HEIGHT = 22, LINE = 15 };

bool fl_contact_sheet_init(FlContactSheet *contact, int columns, int rows, int cell_width,
                           int cell_height, GError **error)
{
    const int width = WORDS_WIDTH + columns * (cell_width + GAP) + GAP;
    const int height = WORDS_HEIGHT + rows * (cell_height + GAP) + GAP;
    *contact = (FlContactSheet){fl_surface_new(CAIRO_FORMAT_RGB24, width, height, error), columns,
                                rows, cell_width, cell_height};
    if (!contact->surface)
        return false;
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    cairo_set_source_rgb(cr, 1, 1, 1);
    cairo_paint(cr);
    return true;
}

void fl_contact_sheet_clear(FlContactSheet *contact)
{
    g_clear_pointer(&contact->surface, cairo_surface_destroy);
}

/* The upper left corner of a cell. */
static void move_to_cell(const FlContactSheet *contact, cairo_t *cr, int column, int row)
{
    cairo_translate(cr, WORDS_WIDTH + GAP + column * (contact->cell_width + GAP),
                    WORDS_HEIGHT + GAP + row * (contact->cell_height + GAP));
}

void fl_contact_sheet_put(const FlContactSheet *contact, int column, int row,
                          cairo_surface_t *picture)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    const int width = cairo_image_surface_get_width(picture);
    const int height = cairo_image_surface_get_height(picture);
    const double across = (double)contact->cell_width / width;
    const double down = (double)contact->cell_height / height;
    const double scale = MIN(MIN(across, down), 1);
    move_to_cell(contact, cr, column, row);
    cairo_translate(cr, (int)(contact->cell_width - scale * width) / 2,
                    (int)(contact->cell_height - scale * height) / 2);
    cairo_scale(cr, scale, scale);
    cairo_set_source_surface(cr, picture, 0, 0);
    cairo_paint(cr);
}

static void set_font(cairo_t *cr, bool bold)
{
    cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL,
                           bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cr, bold ? 14 : 11);
}

static void write_line(cairo_t *cr, double x, double y, bool bold, const char *text)
{
    set_font(cr, bold);
    cairo_set_source_rgb(cr, 0.15, 0.15, 0.15);
    cairo_move_to(cr, x, y);
    cairo_show_text(cr, text);
}

char *fl_take_words(cairo_t *cr, double width, const char **line)
{
    cairo_text_extents_t extents;
    char *fits = NULL;
    for (const char *end = *line; *end;) {
        end += strspn(end, " ");
        end += strcspn(end, " ");
        g_autofree char *words = g_strndup(*line, (gsize)(end - *line));
        cairo_text_extents(cr, words, &extents);
        if (fits && extents.width > width)
            break;
        g_free(fits);
        fits = g_steal_pointer(&words);
    }
    *line += fits ? strlen(fits) : 0;
    *line += strspn(*line, " ");
    return fits ? fits : g_strdup("");
}

void fl_contact_sheet_name_row(const FlContactSheet *contact, int row, const char *name,
                               const char *lines)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    g_auto(GStrv) line = g_strsplit(lines, "\n", -1);
    move_to_cell(contact, cr, 0, row);
    cairo_rectangle(cr, -WORDS_WIDTH, 0, WORDS_WIDTH, contact->cell_height);
    cairo_clip(cr);
    write_line(cr, -WORDS_WIDTH, LINE, true, name);
    set_font(cr, false);
    for (int k = 0, at = 2; line[k]; k++) {
        const char *rest = line[k];
        do {
            g_autofree char *words = fl_take_words(cr, WORDS_WIDTH - GAP, &rest);
            write_line(cr, -WORDS_WIDTH, at++ * LINE + 3, false, words);
        } while (*rest);
    }
}

void fl_contact_sheet_name_column(const FlContactSheet *contact, int column, const char *name)
{
    g_autoptr(cairo_t) cr = cairo_create(contact->surface);
    move_to_cell(contact, cr, column, 0);
    write_line(cr, 0, -GAP, false, name);
}

bool fl_contact_sheet_save(const FlContactSheet *contact, const char *path, bool overwrite,
                           GError **error)
{
    const int width = cairo_image_surface_get_width(contact->surface);
    const int height = cairo_image_surface_get_height(contact->surface);
    g_autofree uint8_t *rgba = fl_surface_bytes(contact->surface, 4, height, error);
    const FlPng png = {.width = width, .height = height, .rgba = rgba, .opaque = true};
    return rgba && fl_png_save(&png, path, overwrite, error);
}
