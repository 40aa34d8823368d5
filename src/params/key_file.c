#include "params/key_file.h"

#include "base/error.h"
#include "base/file.h"
#include <string.h>

#define LARGEST_BYTES (1 << 20)

static char *load(const char *path, const FlKeyReader *reader, GError **error)
{
    g_autofree char *text = g_strdup(reader->text);
    size_t bytes = text ? strlen(text) : 0;
    if (!text && !fl_file_read_pipe(path, LARGEST_BYTES, reader->wait, &text, &bytes, error))
        return NULL;
    if (bytes > LARGEST_BYTES) {
        g_set_error(error, FL_ERROR, FL_ERROR_LIMIT, "%s: the file is larger than 1 MiB", path);
        return NULL;
    }
    if (!g_utf8_validate(text, (gssize)bytes, NULL)) {
        g_set_error(error, FL_ERROR, (int)reader->mistake, "%s: the file is not UTF-8 text", path);
        return NULL;
    }
    return g_steal_pointer(&text);
}

static bool read_section(const FlKeyReader *reader, char *text, int line, GError **error)
{
    char *end = strchr(text, ']');
    if (!end || end[1] != '\0')
        return fl_fail(error, reader->mistake, "“%s” is not a section: “]” must end it", text);
    *end = '\0';
    return reader->section(reader->data, g_strstrip(text + 1), line, error);
}

static bool read_entry(const FlKeyReader *reader, char *text, int line, GError **error)
{
    char *equals = strchr(text, '=');
    if (!equals || equals == text)
        return fl_fail(error, reader->mistake, "“%.40s” is neither “[section]” nor “key = value”",
                       text);
    *equals = '\0';
    return reader->entry(reader->data, g_strstrip(text), g_strstrip(equals + 1), line, error);
}

bool fl_key_file_read(const char *path, const FlKeyReader *reader, GError **error)
{
    g_autofree char *text = load(path, reader, error);
    if (!text)
        return false;
    char *const start = g_str_has_prefix(text, "\xef\xbb\xbf") ? text + 3 : text; // Windows' mark
    g_auto(GStrv) lines = g_strsplit(start, "\n", -1);
    for (int i = 0; lines[i]; i++) {
        char *line = g_strstrip(lines[i]);
        if (*line == '\0' || *line == '#' || *line == ';')
            continue;
        const bool fine = *line == '[' ? read_section(reader, line, i + 1, error)
                                       : read_entry(reader, line, i + 1, error);
        if (!fine) {
            g_prefix_error(error, "%s:%d: ", path, i + 1);
            return false;
        }
    }
    return true;
}

char **fl_key_file_list(const char *value)
{
    g_auto(GStrv) items = g_strsplit(value, ";", -1);
    g_autoptr(GPtrArray) kept = g_ptr_array_new();
    for (int i = 0; items[i]; i++)
        if (*g_strstrip(items[i]))
            g_ptr_array_add(kept, g_strdup(items[i]));
    g_ptr_array_add(kept, NULL);
    return (char **)g_ptr_array_free(g_steal_pointer(&kept), FALSE);
}
