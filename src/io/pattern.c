#include "io/pattern.h"

#include "base/error.h"
#include <stdbool.h>
#include <string.h>

#define MOST_DIGITS 9 // so that a number fits an int
#define MOST_WIDTH 19

void fl_pattern_clear(FlPattern *pattern)
{
    g_clear_pointer(&pattern->prefix, g_free);
    g_clear_pointer(&pattern->suffix, g_free);
}

/** The place of the number in a name. */
typedef struct Place {
    size_t at, length; // length 0: nowhere
    int width;
} Place;

/** Length of the conversion "%d" or "%04d" at s, else 0; its width goes to *width. */
static size_t conversion(const char *s, int *width)
{
    size_t n = 1;
    while (g_ascii_isdigit(s[n]))
        n++;
    if (s[0] != '%' || s[n] != 'd' || g_ascii_strtoull(s + 1, NULL, 10) > MOST_WIDTH)
        return 0;
    *width = MAX((int)g_ascii_strtoull(s + 1, NULL, 10), 1);
    return n + 1;
}

static Place last_hashes(const char *name)
{
    const char *end = strrchr(name, '#'), *first = end;
    if (!end)
        return (Place){0};
    while (first > name && first[-1] == '#')
        first--;
    const size_t n = (size_t)(end + 1 - first);
    return (Place){(size_t)(first - name), n, (int)MIN(n, MOST_WIDTH)};
}

static bool find_number(const char *name, Place *place, GError **error)
{
    *place = (Place){0};
    for (const char *s = strchr(name, '%'); s; s = strchr(s, '%')) {
        int width = 0;
        const size_t n = s[1] == '%' ? 2 : conversion(s, &width);
        if (n == 0 || (width > 0 && place->length > 0))
            return fl_fail(error, FL_ERROR_USAGE,
                           n ? "%s: “%.4s” is a second frame number; expected one"
                             : "%s: “%.4s” is no frame number; expected %%d, %%04d or ####, and "
                               "%%%% for a percent sign",
                           name, s);
        if (width > 0)
            *place = (Place){(size_t)(s - name), n, width};
        s += n;
    }
    if (place->length == 0)
        *place = last_hashes(name);
    return true;
}

/** The text of n bytes with one percent sign for two; to be freed. */
static char *plain(const char *text, size_t n)
{
    GString *out = g_string_new_len(text, (gssize)n);
    g_string_replace(out, "%%", "%", 0);
    return g_string_free(out, FALSE);
}

bool fl_pattern_parse(const char *name, FlPattern *pattern, GError **error)
{
    Place place;
    *pattern = (FlPattern){0};
    if (!find_number(name, &place, error))
        return false;
    const size_t end = place.length ? place.at : strlen(name), next = end + place.length;
    *pattern = (FlPattern){plain(name, end), plain(name + next, strlen(name + next)), place.width};
    return true;
}

bool fl_pattern_match(const FlPattern *pattern, const char *name, int *number)
{
    const size_t before = strlen(pattern->prefix), after = strlen(pattern->suffix);
    const size_t length = strlen(name);
    if (length <= before + after || strncmp(name, pattern->prefix, before) != 0 ||
        strcmp(name + length - after, pattern->suffix) != 0)
        return false;
    const char *digits = name + before;
    const size_t n = length - before - after;
    if (strspn(digits, "0123456789") < n || n < (size_t)pattern->width ||
        n > (size_t)MAX(MOST_DIGITS, pattern->width))
        return false;
    if (pattern->width > 1 && n > (size_t)pattern->width && digits[0] == '0')
        return false; // a_%04d.svg does not match a_00001.svg
    const gint64 value = g_ascii_strtoll(digits, NULL, 10);
    *number = (int)MIN(value, G_MAXINT);
    return value <= G_MAXINT;
}

bool fl_pattern_of_name(const char *name, FlPattern *pattern, int *number)
{
    *pattern = (FlPattern){0};
    const char *dot = strrchr(name, '.');
    const char *end = dot ? dot : name + strlen(name);
    while (end > name && !g_ascii_isdigit(end[-1]))
        end--;
    const char *begin = end;
    while (begin > name && g_ascii_isdigit(begin[-1]))
        begin--;
    if (begin == end || end - begin > MOST_DIGITS)
        return false;
    const int width = begin[0] == '0' ? (int)(end - begin) : 1;
    *pattern = (FlPattern){g_strndup(name, begin - name), g_strdup(end), width};
    *number = (int)g_ascii_strtoll(begin, NULL, 10);
    return true;
}

/** Appends a text as part of a pattern, with % doubled. */
static void append_literal(GString *to, const char *text)
{
    g_autoptr(GString) escaped = g_string_new(text);
    g_string_replace(escaped, "%", "%%", 0);
    g_string_append(to, escaped->str);
}

char *fl_pattern_text(const FlPattern *pattern)
{
    GString *text = g_string_new(NULL);
    append_literal(text, pattern->prefix);
    if (pattern->width == 1)
        g_string_append(text, "%d");
    else if (pattern->width > 1)
        g_string_append_printf(text, "%%0%dd", pattern->width);
    append_literal(text, pattern->suffix);
    return g_string_free(text, FALSE);
}

/** The name with a number, which may be negative; to be freed. */
static char *name_of(const FlPattern *pattern, int number)
{
    if (pattern->width == 0)
        return g_strdup(pattern->prefix);
    return g_strdup_printf("%s%0*d%s", pattern->prefix, pattern->width, number, pattern->suffix);
}

bool fl_output_is_pattern(const char *text)
{
    Place place;
    return find_number(text, &place, NULL) && place.length > 0;
}

bool fl_input_is_pattern(const char *text)
{
    return fl_output_is_pattern(text) && !g_file_test(text, G_FILE_TEST_EXISTS);
}

char *fl_output_name(const char *text, int number, const char *region, GError **error)
{
    g_auto(FlPattern) pattern = {0};
    if (!fl_pattern_parse(text, &pattern, error))
        return NULL;
    g_autofree char *name = name_of(&pattern, number);
    if (!strstr(name, "{region}"))
        return g_steal_pointer(&name);
    if (!region)
        return fl_none(error, FL_ERROR_USAGE, "%s: {region} is allowed in the names of layers only",
                       text);
    g_auto(GStrv) parts = g_strsplit(name, "{region}", -1);
    return g_strjoinv(region, parts);
}

bool fl_output_is_folder(const char *wanted)
{
    return !wanted || g_str_has_suffix(wanted, "/") || g_file_test(wanted, G_FILE_TEST_IS_DIR);
}

/** A text as it stands, as part of a pattern or of a plain name. */
static GString *part_of(bool pattern, const char *text)
{
    GString *part = g_string_new(NULL);
    if (pattern)
        append_literal(part, text);
    else
        g_string_append(part, text);
    return part;
}

char *fl_output_of_film(const char *wanted, const char *tail, const char *film, bool pattern)
{
    const bool folder = fl_output_is_folder(wanted);
    g_autoptr(GString) path = part_of(pattern && folder, wanted ? wanted : "fluidy/");
    g_autoptr(GString) name = part_of(pattern, film);
    if (folder)
        g_string_append_printf(path, "%s{name}%s", g_str_has_suffix(path->str, "/") ? "" : "/",
                               tail);
    g_string_replace(path, "{name}", name->str, 0);
    return g_string_free(g_steal_pointer(&path), FALSE);
}

/* ---- ranges of frames ------------------------------------------------------------------------ */

#define LONGEST 1000000 // frames; a longer range is a typing mistake

static bool read_number(const char **s, int *value)
{
    if (!g_ascii_isdigit(**s))
        return false;
    char *end = NULL;
    const guint64 v = g_ascii_strtoull(*s, &end, 10);
    if (v > G_MAXINT / 2)
        return false;
    *value = (int)v;
    *s = end;
    return true;
}

/** "12~1": a number and its neighbours, clamped to *first … *last as passed in. */
static bool read_around(const char *s, int *first, int *last)
{
    int middle = *first + (*last - *first) / 2, away = 0;
    if (*s != '~' && !read_number(&s, &middle))
        return false;
    if (*s++ != '~' || !read_number(&s, &away) || *s != '\0' || away >= LONGEST)
        return false;
    const bool known = middle >= *first && middle <= *last;
    *first = known ? MAX(middle - away, *first) : middle;
    *last = known ? MIN(middle + away, *last) : middle;
    return true;
}

/** One item between commas; *first and *last come in as the sequence's. Returns: whether it is
 * valid. */
static bool read_part(const char *s, int *first, int *last, int *step)
{
    const int film_last = *last;
    *step = 1;
    if (strchr(s, '~'))
        return read_around(s, first, last);
    if (!read_number(&s, first))
        return false;
    *last = *first;
    if (*s == '-') {
        s++;
        if (!read_number(&s, last))
            *last = film_last;
        if (*s == 'x') {
            s++;
            if (!read_number(&s, step))
                return false;
        }
    }
    return *s == '\0' && *step >= 1 && *last >= *first && *last - *first < LONGEST;
}

static int compare_ints(const void *a, const void *b)
{
    const int x = *(const int *)a, y = *(const int *)b;
    return (x > y) - (x < y);
}

GArray *fl_range_parse(const char *range, int film_first, int film_last, GError **error)
{
    g_autoptr(GArray) numbers = g_array_new(FALSE, FALSE, sizeof(int));
    g_auto(GStrv) parts = g_strsplit(range, ",", -1);
    bool good = parts[0] != NULL;
    for (int i = 0; good && parts[i]; i++) {
        int first = film_first, last = film_last, step = 1;
        good = read_part(g_strstrip(parts[i]), &first, &last, &step);
        for (int n = first; good && n <= last; n += step)
            g_array_append_val(numbers, n);
    }
    if (!good)
        return fl_none(
            error, FL_ERROR_USAGE,
            "frames “%s”: expected numbers and ranges such as 1001-1096, 1-96x2, 1,5,9 or 12~1",
            range);
    g_array_sort(numbers, compare_ints);
    guint kept = 0;
    for (guint i = 0; i < numbers->len; i++)
        if (kept == 0 || g_array_index(numbers, int, i) != g_array_index(numbers, int, kept - 1))
            g_array_index(numbers, int, kept++) = g_array_index(numbers, int, i);
    g_array_set_size(numbers, kept);
    return g_steal_pointer(&numbers);
}

char *fl_range_text(const GArray *numbers)
{
    GString *text = g_string_new(NULL);
    guint i = 0;
    for (int parts = 0; i < numbers->len && parts < 6; parts++) {
        guint j = i;
        const int *n = &g_array_index(numbers, int, 0);
        while (j + 1 < numbers->len && n[j + 1] == n[j] + 1)
            j++;
        g_string_append_printf(text, "%s%d", i ? ", " : "", n[i]);
        if (j > i)
            g_string_append_printf(text, "-%d", n[j]);
        i = j + 1;
    }
    if (i < numbers->len)
        g_string_append_printf(text, " and %u more", numbers->len - i);
    return g_string_free(text, FALSE);
}
