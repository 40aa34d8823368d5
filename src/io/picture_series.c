#include "io/picture_series.h"

#include <stdlib.h>
#include <string.h>

/* A file name taken apart at its last run of digits. */
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

static const char *ending_of(const char *file, const char *const *endings)
{
    g_autofree char *lower = g_ascii_strdown(file, -1);
    for (; *endings; endings++)
        if (g_str_has_suffix(lower, *endings))
            return file + strlen(file) - strlen(*endings);
    return NULL;
}

/* The number must stand right before the ending, at most 9 digits. */
static bool split_name(Name *name, const char *folder, const char *file, const char *const *endings)
{
    const char *end = ending_of(file, endings), *start = end;
    while (start && start > file && g_ascii_isdigit(start[-1]))
        start--;
    if (!end || start == end || end - start > 9)
        return false;
    g_autofree char *stem = g_strndup(file, (gsize)(start - file));
    *name = (Name){
        .path = g_build_filename(folder, file, NULL),
        .prefix = g_strconcat(folder, G_DIR_SEPARATOR_S, stem, NULL),
        .suffix = g_strdup(end),
        .number = atoi(start),
        .digits = (int)(end - start),
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

GPtrArray *fl_series_in_folder(const char *folder, const char *const *endings, GError **error)
{
    g_autoptr(GError) below = NULL;
    g_autoptr(GDir) dir = g_dir_open(folder, 0, &below);
    if (!dir) {
        g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s: cannot be read: %s", folder,
                    below->message);
        return NULL;
    }
    g_autoptr(GArray) names = g_array_new(FALSE, FALSE, sizeof(Name));
    g_array_set_clear_func(names, clear_name);
    const char *file;
    while ((file = g_dir_read_name(dir))) {
        Name name;
        if (file[0] != '.' && split_name(&name, folder, file, endings))
            g_array_append_val(names, name);
    }
    g_array_sort(names, compare_names);

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

/* Where the pattern's number stands and how long it is; false if there is none. */
static bool find_number(const char *pattern, const char **start, size_t *length)
{
    const char *slash = strrchr(pattern, '/');
    const char *base = slash ? slash + 1 : pattern;
    const char *percent = strchr(base, '%');
    if (percent) {
        *start = percent;
        *length = strspn(percent + 1, "0123456789") + 2;
        return percent[*length - 1] == 'd';
    }
    *start = strchr(base, '#');
    *length = *start ? strspn(*start, "#") : 0;
    return *start;
}

bool fl_is_pattern(const char *text)
{
    const char *start;
    size_t length;
    return find_number(text, &start, &length);
}

FlSeries *fl_series_of_pattern(const char *pattern, GError **error)
{
    const char *start;
    size_t length;
    if (!find_number(pattern, &start, &length)) {
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT,
                    "%s: expected a pattern with a number, such as paint_%%04d.png", pattern);
        return NULL;
    }
    g_autofree char *folder = g_path_get_dirname(pattern);
    g_autofree char *stem = g_strndup(pattern, (gsize)(start - pattern));
    g_autofree char *base = strrchr(stem, '/') ? g_strdup(strrchr(stem, '/') + 1) : g_strdup(stem);
    g_autofree char *prefix = g_strconcat(folder, G_DIR_SEPARATOR_S, base, NULL);
    const char *endings[] = {start + length, NULL};
    g_autofree char *lower = g_ascii_strdown(endings[0], -1);
    endings[0] = lower;
    g_autoptr(GPtrArray) all = fl_series_in_folder(folder, endings, error);
    for (guint i = 0; all && i < all->len; i++) {
        FlSeries *series = g_ptr_array_index(all, i);
        if (strcmp(series->prefix, prefix) == 0)
            return g_ptr_array_steal_index(all, i);
    }
    if (all)
        g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: no file has a name like this", pattern);
    return NULL;
}

char *fl_series_path(const FlSeries *series, int number)
{
    return g_strdup_printf("%s%0*d%s", series->prefix, series->digits, number, series->suffix);
}

bool fl_series_check(const FlSeries *series, GError **error)
{
    for (int i = 1; i < series->n; i++) {
        const int before = series->number[i - 1];
        if (series->number[i] == before) {
            g_set_error(error, FL_ERROR, FL_ERROR_STYLE, "%s and %s have the same number",
                        series->path[i - 1], series->path[i]);
            return false;
        }
        if (series->number[i] > before + 1) {
            g_autofree char *missing = fl_series_path(series, before + 1);
            g_set_error(error, FL_ERROR, FL_ERROR_STYLE,
                        "%s is missing: expected every number from %d to %d", missing,
                        series->number[0], series->number[series->n - 1]);
            return false;
        }
    }
    return true;
}
