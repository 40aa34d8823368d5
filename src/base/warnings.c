#include "base/warnings.h"

struct FlWarnings {
    GPtrArray *list;
    GHashTable *known; // "element\ntext" -> FlWarning
};

static void warning_free(gpointer data)
{
    FlWarning *w = data;
    g_free(w->file);
    g_free(w->element);
    g_free(w->text);
    g_free(w);
}

FlWarnings *fl_warnings_new(void)
{
    FlWarnings *warnings = g_new0(FlWarnings, 1);
    warnings->list = g_ptr_array_new_with_free_func(warning_free);
    warnings->known = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    return warnings;
}

void fl_warnings_free(FlWarnings *warnings)
{
    if (!warnings)
        return;
    g_hash_table_unref(warnings->known);
    g_ptr_array_unref(warnings->list);
    g_free(warnings);
}

static void add(FlWarnings *warnings, const char *file, int frame, const char *element,
                const char *text, int n_frames)
{
    g_autofree char *key = g_strdup_printf("%s\n%s", element, text);
    FlWarning *before = g_hash_table_lookup(warnings->known, key);
    if (before) {
        before->n_frames += before->last == frame ? 0 : n_frames;
        before->last = frame;
        return;
    }
    FlWarning *w = g_new0(FlWarning, 1);
    *w = (FlWarning){g_strdup(file), g_strdup(element), g_strdup(text), frame, frame, n_frames};
    g_ptr_array_add(warnings->list, w);
    g_hash_table_insert(warnings->known, g_steal_pointer(&key), w);
}

void fl_warnings_add(FlWarnings *warnings, const char *file, int frame, const char *element,
                     const char *format, ...)
{
    if (!warnings)
        return;
    va_list args;
    va_start(args, format);
    g_autofree char *text = g_strdup_vprintf(format, args);
    va_end(args);
    add(warnings, file, frame, element ? element : "", text, 1);
}

void fl_warnings_repeat(FlWarnings *warnings, const FlWarning *w)
{
    add(warnings, w->file, w->frame, w->element, w->text, w->n_frames);
}

void fl_warnings_append(FlWarnings *warnings, const FlWarnings *from)
{
    for (int i = 0; warnings && i < fl_warnings_count(from); i++)
        fl_warnings_repeat(warnings, fl_warnings_get(from, i));
}

int fl_warnings_count(const FlWarnings *warnings)
{
    return (int)warnings->list->len;
}

const FlWarning *fl_warnings_get(const FlWarnings *warnings, int i)
{
    return g_ptr_array_index(warnings->list, i);
}

char *fl_warning_line(const FlWarning *w)
{
    GString *line = g_string_new(w->file);
    if (w->element[0])
        g_string_append_printf(line, ": #%s", w->element);
    g_string_append_printf(line, ": %s", w->text);
    if (w->n_frames > 1)
        g_string_append_printf(line, " (and in %d more frame%s)", w->n_frames - 1,
                               w->n_frames == 2 ? "" : "s");
    return g_string_free(line, FALSE);
}
