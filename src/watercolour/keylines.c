#include "watercolour/keylines.h"

#include "base/suggest.h"
#include "params/key_file.h"
#include "params/text.h"

#include <math.h>
#include <string.h>

typedef struct Entry {
    char *key, *value; // key NULL: the line of a [group], whose name is value
    int line;
} Entry;

struct FlKeyLines {
    char *path;
    GArray *entries;     // Entry
    GArray *groups;      // unsigned: index of the group's entry
    GPtrArray *asked;    // keys of the group at hand; static strings
    unsigned first, end; // entries of the group at hand
    GError *error;
};

static void clear_entry(void *data)
{
    Entry *entry = data;
    g_free(entry->key);
    g_free(entry->value);
}

void fl_keylines_free(FlKeyLines *lines)
{
    if (!lines)
        return;
    g_free(lines->path);
    g_array_unref(lines->entries);
    g_array_unref(lines->groups);
    g_ptr_array_unref(lines->asked);
    g_clear_error(&lines->error);
    g_free(lines);
}

static bool add_group(void *data, const char *name, int line, GError **error)
{
    FlKeyLines *lines = data;
    const Entry entry = {.value = g_strdup(name), .line = line};
    g_array_append_val(lines->groups, lines->entries->len);
    g_array_append_val(lines->entries, entry);
    return true;
}

static bool add_key(void *data, const char *key, const char *value, int line, GError **error)
{
    FlKeyLines *lines = data;
    const Entry entry = {g_strdup(key), g_strdup(value), line};
    g_array_append_val(lines->entries, entry);
    if (lines->groups->len > 0)
        return true;
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "“%s” stands above the first [group]", key);
    return false;
}

FlKeyLines *fl_keylines_load(const char *path, GError **error)
{
    g_autoptr(FlKeyLines) lines = g_new0(FlKeyLines, 1);
    lines->path = g_strdup(path);
    lines->entries = g_array_new(FALSE, FALSE, sizeof(Entry));
    g_array_set_clear_func(lines->entries, clear_entry);
    lines->groups = g_array_new(FALSE, FALSE, sizeof(unsigned));
    lines->asked = g_ptr_array_new();
    const FlKeyReader reader = {add_group, add_key, lines, FL_ERROR_INPUT, NULL};
    return fl_key_file_read(path, &reader, error) ? g_steal_pointer(&lines) : NULL;
}

int fl_keylines_n_groups(const FlKeyLines *lines)
{
    return (int)lines->groups->len;
}

static Entry *entry_at(const FlKeyLines *lines, unsigned index)
{
    return &g_array_index(lines->entries, Entry, index);
}

static unsigned group_start(const FlKeyLines *lines, int group)
{
    return (unsigned)group < lines->groups->len ? g_array_index(lines->groups, unsigned, group)
                                                : lines->entries->len;
}

const char *fl_keylines_group(const FlKeyLines *lines, int group)
{
    return entry_at(lines, group_start(lines, group))->value;
}

void fl_keylines_begin(FlKeyLines *lines, int group)
{
    lines->first = group_start(lines, group);
    lines->end = group_start(lines, group + 1);
    g_ptr_array_set_size(lines->asked, 0);
}

static const Entry *find(FlKeyLines *lines, const char *key)
{
    g_ptr_array_add(lines->asked, (void *)key);
    const Entry *found = NULL; // the last of equals counts
    for (unsigned i = lines->first + 1; i < lines->end; i++)
        if (strcmp(entry_at(lines, i)->key, key) == 0)
            found = entry_at(lines, i);
    return lines->error ? NULL : found;
}

static void complain(FlKeyLines *lines, int line, const char *format, va_list arguments)
{
    if (lines->error)
        return;
    g_autofree char *text = g_strdup_vprintf(format, arguments);
    g_set_error(&lines->error, FL_ERROR, FL_ERROR_INPUT, "%s:%d: [%s] %s", lines->path, line,
                entry_at(lines, lines->first)->value, text);
}

void fl_keylines_complain(FlKeyLines *lines, const char *key, const char *format, ...)
{
    const Entry *entry = find(lines, key);
    va_list arguments;
    va_start(arguments, format);
    complain(lines, entry ? entry->line : entry_at(lines, lines->first)->line, format, arguments);
    va_end(arguments);
}

bool fl_keylines_end(FlKeyLines *lines, GError **error)
{
    g_ptr_array_add(lines->asked, NULL);
    const char *const *known = (const char *const *)lines->asked->pdata;
    for (unsigned i = lines->first + 1; i < lines->end && !lines->error; i++) {
        const Entry *entry = entry_at(lines, i);
        if (g_strv_contains(known, entry->key))
            continue;
        g_autofree char *hint = fl_did_you_mean(entry->key, known);
        g_set_error(&lines->error, FL_ERROR, FL_ERROR_INPUT, "%s:%d: [%s] has no key “%s”%s",
                    lines->path, entry->line, entry_at(lines, lines->first)->value, entry->key,
                    hint);
    }
    if (!lines->error)
        return true;
    g_propagate_error(error, g_steal_pointer(&lines->error));
    return false;
}

void fl_keylines_string(FlKeyLines *lines, const char *key, char **value)
{
    const Entry *entry = find(lines, key);
    if (!entry)
        return;
    g_free(*value);
    *value = g_strdup(entry->value);
}

void fl_keylines_bool(FlKeyLines *lines, const char *key, bool *value)
{
    const Entry *entry = find(lines, key);
    if (!entry)
        return;
    if (strcmp(entry->value, "on") != 0 && strcmp(entry->value, "off") != 0)
        fl_keylines_complain(lines, key, "%s: “%s”: expected on or off", key, entry->value);
    else
        *value = strcmp(entry->value, "on") == 0;
}

void fl_keylines_colour(FlKeyLines *lines, const char *key, uint8_t rgb[3])
{
    const Entry *entry = find(lines, key);
    if (!entry)
        return;
    if (!fl_text_colour(entry->value, rgb))
        fl_keylines_complain(lines, key, "%s: “%s”: expected a colour such as #f4efe4", key,
                             entry->value);
}

int fl_keylines_floats(FlKeyLines *lines, const char *key, int least, int most, float min,
                       float max, float *values)
{
    const Entry *entry = find(lines, key);
    if (!entry)
        return 0;
    const char *at = entry->value;
    int n = 0;
    for (; n < most; n++) {
        at += strspn(at, " ,\t");
        char *end = NULL;
        const double x = g_ascii_strtod(at, &end);
        if (end == at || !isfinite(x) || x < min || x > max)
            break;
        values[n] = (float)x;
        at = end;
    }
    if (n >= least && at[strspn(at, " ,\t")] == '\0')
        return n;
    g_autofree char *count =
        least == most ? g_strdup_printf("%d", least) : g_strdup_printf("%d to %d", least, most);
    fl_keylines_complain(lines, key, "%s: “%s”: expected %s number%s from %g to %g", key,
                         entry->value, most == 1 ? "a" : count, most == 1 ? "" : "s", min, max);
    return 0;
}

void fl_keylines_float(FlKeyLines *lines, const char *key, float min, float max, float *value)
{
    fl_keylines_floats(lines, key, 1, 1, min, max, value);
}

void fl_keylines_int(FlKeyLines *lines, const char *key, int min, int max, int *value)
{
    float x = 0;
    if (!fl_keylines_floats(lines, key, 1, 1, (float)min, (float)max, &x))
        return;
    if (x != floorf(x))
        fl_keylines_complain(lines, key, "%s: expected a whole number", key);
    else
        *value = (int)x;
}
