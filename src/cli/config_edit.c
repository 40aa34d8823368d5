#include "config_edit.h"

#include <stdbool.h>
#include <string.h>

/* "region  hair " as "region hair". */
static char *section_name(const char *line)
{
    const char *end = strrchr(line, ']');
    g_autofree char *name = g_strndup(line + 1, end ? (size_t)(end - line) - 1 : strlen(line) - 1);
    g_strstrip(name);
    if (!g_str_has_prefix(name, "region") || !g_ascii_isspace(name[6]))
        return g_steal_pointer(&name);
    return g_strdup_printf("region %s", g_strchug(name + 6));
}

/* Splits "key = value"; false: the line is something else. */
static bool split_entry(const char *line, char **key, char **value)
{
    g_autofree char *text = g_strstrip(g_strdup(line));
    char *equals = strchr(text, '=');
    if (*text == '#' || *text == ';' || *text == '[' || !equals || equals == text)
        return false;
    *equals = '\0';
    *key = g_strdup(g_strstrip(text));
    *value = g_strdup(g_strstrip(equals + 1));
    return true;
}

char *fl_config_edit_map(const char *text, FlConfigValue map, void *data)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    g_autoptr(GString) made = g_string_new(NULL);
    g_autofree char *section = g_strdup("");
    for (char **line = lines; *line; line++) {
        g_autofree char *bare = g_strstrip(g_strdup(*line)), *key = NULL, *value = NULL;
        if (*bare == '[') {
            g_free(section);
            section = section_name(bare);
        }
        const bool entry = split_entry(*line, &key, &value);
        g_autofree char *now = entry ? map(section, key, value, data) : NULL;
        if (entry && !now)
            continue;
        if (!entry || strcmp(now, value) == 0)
            g_string_append(made, *line);
        else
            g_string_append_printf(made, "%s = %s", key, now);
        g_string_append(made, line[1] ? "\n" : "");
    }
    return g_string_free(g_steal_pointer(&made), FALSE);
}

/* A wanted key, and its place in the text. */
typedef struct Wanted {
    const char *section, *key;
    const char *now; // "": removed
    bool found;
} Wanted;

static char *replace(const char *section, const char *key, const char *value, void *data)
{
    Wanted *wanted = data;
    if (strcmp(section, wanted->section) != 0 || strcmp(key, wanted->key) != 0)
        return g_strdup(value);
    wanted->found = true;
    return *wanted->now ? g_strdup(wanted->now) : NULL;
}

/* Behind the line of the section, or behind a new one at the end. */
static char *add_entry(const char *text, const Wanted *wanted)
{
    g_auto(GStrv) lines = g_strsplit(text, "\n", -1);
    g_autoptr(GString) made = g_string_new(NULL);
    bool added = false;
    for (char **line = lines; *line; line++) {
        g_autofree char *bare = g_strstrip(g_strdup(*line));
        g_autofree char *section = *bare == '[' ? section_name(bare) : NULL;
        g_string_append_printf(made, "%s%s", *line, line[1] ? "\n" : "");
        if (added || g_strcmp0(section, wanted->section) != 0)
            continue;
        g_string_append_printf(made, "%s%s = %s%s", line[1] ? "" : "\n", wanted->key, wanted->now,
                               line[1] ? "\n" : "");
        added = true;
    }
    if (!added)
        g_string_append_printf(made, "%s%s[%s]\n%s = %s\n",
                               made->len && !g_str_has_suffix(made->str, "\n") ? "\n" : "",
                               made->len ? "\n" : "", wanted->section, wanted->key, wanted->now);
    return g_string_free(g_steal_pointer(&made), FALSE);
}

char *fl_config_edit_set(const char *text, const char *section, const char *key, const char *value)
{
    Wanted wanted = {section, key, value, false};
    g_autofree char *made = fl_config_edit_map(text, replace, &wanted);
    return wanted.found || !*value ? g_steal_pointer(&made) : add_entry(made, &wanted);
}
