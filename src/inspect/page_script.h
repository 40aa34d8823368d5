/* The page of a report, and the scripts in it. */
#pragma once

#include "base/picture.h"
#include <glib.h>
#include <stdio.h>

/** A file of report.gresource.xml. Returns: to be freed with g_bytes_unref(). */
GBytes *fl_page_file(const char *name);

/** The report's page before its frames, and what comes after them. */
typedef enum FlPagePart { FL_PAGE_HEAD, FL_PAGE_REST } FlPagePart;

/** Returns: to be freed with g_bytes_unref(). */
GBytes *fl_page_part(FlPagePart part);

/**
 * Appends a picture as a data URI in quotes, with alpha unless it is opaque; name as of
 * fl_json_text(). FL_ERROR_NO_MEMORY.
 */
bool fl_script_picture(GString *json, const char *name, const FlPicture *picture, bool opaque,
                       GError **error);

/** Writes a script of JSON between two pieces. Whatever the JSON holds, it does not end the script;
 * it is changed for that. */
void fl_script_write(FILE *out, const char *before, GString *json, const char *after);
