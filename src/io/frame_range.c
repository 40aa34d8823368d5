#include "io/frame_range.h"

#include <stdbool.h>
#include <string.h>

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
    GArray *numbers = g_array_new(FALSE, FALSE, sizeof(int));
    g_auto(GStrv) parts = g_strsplit(range, ",", -1);
    bool good = parts[0] != NULL;
    for (int i = 0; good && parts[i]; i++) {
        int first = film_first, last = film_last, step = 1;
        good = read_part(g_strstrip(parts[i]), &first, &last, &step);
        for (int n = first; good && n <= last; n += step)
            g_array_append_val(numbers, n);
    }
    if (!good) {
        g_set_error(
            error, FL_ERROR, FL_ERROR_USAGE,
            "frames “%s”: expected numbers and ranges such as 1001-1096, 1-96x2, 1,5,9 or 12~1",
            range);
        g_array_unref(numbers);
        return NULL;
    }
    g_array_sort(numbers, compare_ints);
    guint kept = 0;
    for (guint i = 0; i < numbers->len; i++)
        if (kept == 0 || g_array_index(numbers, int, i) != g_array_index(numbers, int, kept - 1))
            g_array_index(numbers, int, kept++) = g_array_index(numbers, int, i);
    g_array_set_size(numbers, kept);
    return numbers;
}
