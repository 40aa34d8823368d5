/* Pieces of JSON text. */
#pragma once

#include <glib.h>
#include <stdbool.h>

/** Appends a string in quotes, made valid UTF-8; NULL is null. */
void fl_json_string(GString *json, const char *text);

/* Those below begin with a comma unless an object or a list begins, and with the name of a member
 * of an object; name NULL: an item of a list. */

/** Begins an object, {, or a list, [. An object in a list begins a line. */
void fl_json_begin(GString *json, const char *name, char bracket);

void fl_json_text(GString *json, const char *name, const char *text);

/** A whole number, or one of six digits, whatever the locale; null if it is not known, or not
 * finite. */
void fl_json_number(GString *json, const char *name, double value, bool known);

void fl_json_bool(GString *json, const char *name, bool value);
