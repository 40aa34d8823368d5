/* Pieces of JSON text. */
#ifndef FLUIDY_BASE_JSON_H
#define FLUIDY_BASE_JSON_H

#include <glib.h>
#include <stdbool.h>

/** Appends a string in quotes, made valid UTF-8; NULL is null. */
void fl_json_string(GString *json, const char *text);

/** Appends "name": and a string, with a comma before it unless an object or a list begins. */
void fl_json_text(GString *json, const char *name, const char *text);

/** The same with a number of six digits, whatever the locale, or with null if it is not known. */
void fl_json_number(GString *json, const char *name, double value, bool known);

#endif
