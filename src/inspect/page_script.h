/* Writes JavaScript values into a page. */
#ifndef FLUIDY_INSPECT_PAGE_SCRIPT_H
#define FLUIDY_INSPECT_PAGE_SCRIPT_H

#include "base/picture.h"
#include <glib.h>
#include <stdio.h>

/** A file of report.gresource.xml. Returns: to be freed with g_bytes_unref(). */
GBytes *fl_page_file(const char *name);

/** The report's page before its frames, and what comes after them. */
typedef enum FlPagePart { FL_PAGE_HEAD, FL_PAGE_REST } FlPagePart;

/** Returns: to be freed with g_bytes_unref(). */
GBytes *fl_page_part(FlPagePart part);

/** A quoted string; NULL: null. Whatever it contains, it ends neither itself nor the script. */
void fl_script_string(FILE *out, const char *text);

/** A number, with six digits; null if it is not finite. */
void fl_script_number(FILE *out, double value);

/** "#rrggbb" in quotes. */
void fl_script_colour(FILE *out, const uint8_t rgb[3]);

/**
 * A picture as a data URI in quotes, with alpha unless it is opaque. FL_ERROR_NO_MEMORY.
 */
bool fl_script_picture(FILE *out, const FlPicture *picture, bool opaque, GError **error);

#endif
