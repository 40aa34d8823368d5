#include "io/picture_series.h"

#include "base/each.h"
#include "base/error.h"
#include "io/pattern.h"

#include <string.h>

/* A file name split at its last number. */
typedef struct Name {
    char *path, *prefix, *suffix;
    int number, digits;
} Name;

static void clear_name(void *data)
{
    Name *name = data;
    g_free(name->path);
    g_free(name->prefix);
    g_free(name->suffix);
}

static bool is_ending(const char *suffix, const char *const *endings)
{
    for (; *endings; endings++)
        if (g_ascii_strcasecmp(suffix, *endings) == 0)
            return true;
    return false;
}

/* True if a file name matches the pattern; NULL: has its number right before one of the endings. */
static bool split_name(Name *name, const char *folder, const char *file, const FlPattern *wanted,
                       const char *const *endings)
{
    g_auto(FlPattern) own = {0};
    int number;
    if (wanted ? !fl_pattern_match(wanted, file, &number)
               : !fl_pattern_of_name(file, &own, &number) || !is_ending(own.suffix, endings))
        return false;
    const char *prefix = wanted ? wanted->prefix : own.prefix;
    const char *suffix = wanted ? wanted->suffix : own.suffix;
    *name = (Name){
        .path = g_build_filename(folder, file, NULL),
        .prefix = g_strconcat(folder, G_DIR_SEPARATOR_S, prefix, NULL),
        .suffix = g_strdup(suffix),
        .number = number,
        .digits = (int)(strlen(file) - strlen(prefix) - strlen(suffix)),
    };
    return true;
}

static int compare_names(const void *a, const void *b)
{
    const Name *p = a, *q = b;
    int order = strcmp(p->prefix, q->prefix);
    if (order == 0)
        order = strcmp(p->suffix, q->suffix);
    if (order == 0)
        order = (p->number > q->number) - (p->number < q->number);
    return order ? order : strcmp(p->path, q->path);
}

static FlSeries *make_series(const Name *name, int n)
{
    FlSeries *series = g_new(FlSeries, 1);
    *series = (FlSeries){
        .prefix = g_strdup(name->prefix),
        .suffix = g_strdup(name->suffix),
        .digits = name->digits,
        .n = n,
        .number = g_new(int, n),
        .path = g_new0(char *, n + 1),
    };
    for (int i = 0; i < n; i++) {
        series->number[i] = name[i].number;
        series->path[i] = g_strdup(name[i].path);
    }
    return series;
}

void fl_series_free(FlSeries *series)
{
    if (!series)
        return;
    g_free(series->prefix);
    g_free(series->suffix);
    g_free(series->number);
    g_strfreev(series->path);
    g_free(series);
}

/* The matching names of a folder, in order. */
static GArray *list_names(const char *folder, const FlPattern *wanted, const char *const *endings,
                          GError **error)
{
    g_autoptr(GError) below = NULL;
    g_autoptr(GDir) dir = g_dir_open(folder, 0, &below);
    if (!dir) {
        const bool no_match = wanted && g_error_matches(below, G_FILE_ERROR, G_FILE_ERROR_NOENT);
        return fl_none(error, no_match ? FL_ERROR_INPUT : FL_ERROR_STYLE, "%s: cannot be read: %s",
                       folder, below->message);
    }
    GArray *names = fl_array_of(Name, clear_name);
    const char *file;
    while ((file = g_dir_read_name(dir))) {
        Name name;
        if (file[0] != '.' && split_name(&name, folder, file, wanted, endings))
            g_array_append_val(names, name);
    }
    g_array_sort(names, compare_names);
    return names;
}

GPtrArray *fl_series_in_folder(const char *folder, const char *const *endings, GError **error)
{
    g_autoptr(GArray) names = list_names(folder, NULL, endings, error);
    if (!names)
        return NULL;
    GPtrArray *all = g_ptr_array_new_with_free_func((GDestroyNotify)fl_series_free);
    const Name *name = (const Name *)names->data;
    for (guint i = 0, first = 0; i < names->len; i++)
        if (i + 1 == names->len || strcmp(name[i].prefix, name[i + 1].prefix) != 0 ||
            strcmp(name[i].suffix, name[i + 1].suffix) != 0) {
            g_ptr_array_add(all, make_series(name + first, (int)(i + 1 - first)));
            first = i + 1;
        }
    return all;
}

FlSeries *fl_series_of_pattern(const char *text, GError **error)
{
    g_autofree char *folder = g_path_get_dirname(text), *base = g_path_get_basename(text);
    g_auto(FlPattern) pattern = {0};
    if (!fl_pattern_parse(base, &pattern, error))
        return NULL;
    if (pattern.width == 0)
        return fl_none(error, FL_ERROR_INPUT,
                       "%s: expected a pattern with a number, such as paint_%%04d.png", text);
    g_autoptr(GArray) names = list_names(folder, &pattern, NULL, error);
    if (names && names->len > 0)
        return make_series((const Name *)names->data, (int)names->len);
    if (names)
        fl_fail(error, FL_ERROR_INPUT, "%s: matches no file", text);
    return NULL;
}

FlSeries *fl_series_of_file(const char *path)
{
    const Name name = {.path = (char *)path, .number = 1};
    return make_series(&name, 1);
}

char *fl_series_path(const FlSeries *series, int number)
{
    return g_strdup_printf("%s%0*d%s", series->prefix, series->digits, number, series->suffix);
}

bool fl_series_check(const FlSeries *series, GError **error)
{
    for (int i = 1; i < series->n; i++) {
        const int before = series->number[i - 1];
        if (series->number[i] == before)
            return fl_fail(error, FL_ERROR_STYLE, "%s and %s have the same number",
                           series->path[i - 1], series->path[i]);
        if (series->number[i] > before + 1) {
            g_autofree char *missing = fl_series_path(series, before + 1);
            return fl_fail(error, FL_ERROR_STYLE,
                           "%s is missing: expected every number from %d to %d", missing,
                           series->number[0], series->number[series->n - 1]);
        }
    }
    return true;
}
