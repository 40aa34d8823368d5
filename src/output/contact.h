/* A sheet of pictures in rows and columns, with words beside and above them. */
#ifndef FLUIDY_OUTPUT_CONTACT_H
#define FLUIDY_OUTPUT_CONTACT_H

#include "base/surface.h"
#include <stdbool.h>

/** A sheet in the making; white where nothing is put. */
typedef struct FlContact {
    cairo_surface_t *surface;
    int columns, rows;
    int cell_width, cell_height; // px, of the pictures
} FlContact;

/** A sheet for columns x rows pictures, shown in cells of this size. FL_ERROR_LIMIT,
 * FL_ERROR_NO_MEMORY. */
bool fl_contact_init(FlContact *contact, int columns, int rows, int cell_width, int cell_height,
                     GError **error);
void fl_contact_clear(FlContact *contact);

/** Puts a picture into the middle of a cell, made smaller where it is larger, over white. */
void fl_contact_put(const FlContact *contact, int column, int row, cairo_surface_t *picture);

/** Words at the left of a row: a line in bold, then lines of small print; text is cut to fit. */
void fl_contact_name_row(const FlContact *contact, int row, const char *name, const char *lines);

/** Words above a column. */
void fl_contact_name_column(const FlContact *contact, int column, const char *name);

/** Writes the sheet as a PNG file. FL_ERROR_OUTPUT, FL_ERROR_EXISTS, FL_ERROR_NO_MEMORY. */
bool fl_contact_save(const FlContact *contact, const char *path, bool overwrite, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlContact, fl_contact_clear)

#endif
