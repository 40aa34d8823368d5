#include "base/json.h"

#include <math.h>
#include <string.h>

void fl_json_string(GString *json, const char *text)
{
    if (!text) {
        g_string_append(json, "null");
        return;
    }
    g_autofree char *valid = g_utf8_make_valid(text, -1);
    g_string_append_c(json, '"');
    for (const char *at = valid; *at; at++)
        if (*at == '"' || *at == '\\')
            g_string_append_printf(json, "\\%c", *at);
        else if ((unsigned char)*at < 0x20)
            g_string_append_printf(json, "\\u%04x", (unsigned char)*at);
        else
            g_string_append_c(json, *at);
    g_string_append_c(json, '"');
}

static void begin_value(GString *json, const char *name)
{
    if (json->len > 0 && !strchr("{[", json->str[json->len - 1]))
        g_string_append_c(json, ',');
    if (!name)
        return;
    fl_json_string(json, name);
    g_string_append_c(json, ':');
}

void fl_json_begin(GString *json, const char *name, char bracket)
{
    begin_value(json, name);
    if (!name && bracket == '{' && json->len > 0)
        g_string_append_c(json, '\n');
    g_string_append_c(json, bracket);
}

void fl_json_text(GString *json, const char *name, const char *text)
{
    begin_value(json, name);
    fl_json_string(json, text);
}

void fl_json_number(GString *json, const char *name, double value, bool known)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    const bool whole = value == floor(value) && fabs(value) < 1e15;
    begin_value(json, name);
    g_ascii_formatd(text, sizeof text, whole ? "%.0f" : "%.6g", value);
    g_string_append(json, known && isfinite(value) ? text : "null");
}

void fl_json_bool(GString *json, const char *name, bool value)
{
    begin_value(json, name);
    g_string_append(json, value ? "true" : "false");
}
