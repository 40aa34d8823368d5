#include "base/json.h"

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

static void put_name(GString *json, const char *name)
{
    if (json->len > 0 && !strchr("{[", json->str[json->len - 1]))
        g_string_append_c(json, ',');
    fl_json_string(json, name);
    g_string_append_c(json, ':');
}

void fl_json_text(GString *json, const char *name, const char *text)
{
    put_name(json, name);
    fl_json_string(json, text);
}

void fl_json_number(GString *json, const char *name, double value, bool known)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    put_name(json, name);
    g_string_append(json, known ? g_ascii_formatd(text, sizeof text, "%.6g", value) : "null");
}
