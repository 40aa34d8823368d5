/* A sheet of pictures in rows and columns, with captions beside and above them. */
#pragma once

#include "base/surface.h"
#include <stdbool.h>

/** A sheet, white where there is no picture. */
typedef struct FlContactSheet {
    cairo_surface_t *surface;
    int columns, rows;
    int cell_width, cell_height; // px, of the pictures
} FlContactSheet;

/** A sheet for columns x rows pictures, shown in cells of this size. FL_ERROR_LIMIT,
 * FL_ERROR_NO_MEMORY. */
bool fl_contact_sheet_init(FlContactSheet *contact, int columns, int rows, int cell_width,
                           int cell_height, GError **error);
void fl_contact_sheet_clear(FlContactSheet *contact);

/** Centres a picture in a cell, over white, scaled down if it is larger. */
void fl_contact_sheet_put(const FlContactSheet *contact, int column, int row,
                          cairo_surface_t *picture);

/** The caption at the left of a row: a bold line, then small print whose lines are broken
 * to fit. */
void fl_contact_sheet_name_row(const FlContactSheet *contact, int row, const char *name,
                               const char *lines);

/** The caption above a column. */
void fl_contact_sheet_name_column(const FlContactSheet *contact, int column, const char *name);

/** Takes the words that fit into a width, at least one, from the front of *line. To be freed. */
char *fl_take_words(cairo_t *cr, double width, const char **line);

/** Writes the sheet as a PNG file. FL_ERROR_OUTPUT, FL_ERROR_EXISTS, FL_ERROR_NO_MEMORY. */
bool fl_contact_sheet_save(const FlContactSheet *contact, const char *path, bool overwrite,
                           GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlContactSheet, fl_contact_sheet_clear)
