#include "io/output_name.h"

#include <string.h>

/** A conversion %d or %0Nd at text: its length and its digits; 0 if it is not one. */
static size_t conversion(const char *text, int *digits)
{
    const char *at = text;
    int n = 0;
    if (*at++ != '%')
        return 0;
    while (g_ascii_isdigit(*at) && n < 100)
        n = 10 * n + *at++ - '0';
    *digits = n;
    return *at == 'd' && n < 20 ? (size_t)(at + 1 - text) : 0;
}

/** The last run of '#' in the pattern, which a frame number replaces; NULL if there is none. */
static const char *last_hashes(const char *pattern, size_t *length)
{
    const char *last = strrchr(pattern, '#');
    if (!last)
        return NULL;
    const char *first = last;
    while (first > pattern && first[-1] == '#')
        first--;
    *length = (size_t)(last + 1 - first);
    return first;
}

static const char *find_conversion(const char *pattern, size_t *length, int *digits)
{
    for (const char *at = pattern; *at; at++) {
        if (at[0] == '%' && at[1] == '%')
            at++;
        else if ((*length = conversion(at, digits)) > 0)
            return at;
    }
    return NULL;
}

/** The place of the frame number; NULL if there is none. */
static const char *find_number(const char *pattern, size_t *length, int *digits)
{
    const char *at = find_conversion(pattern, length, digits);
    if (!at && (at = last_hashes(pattern, length)))
        *digits = (int)*length;
    return at;
}

bool fl_output_is_pattern(const char *pattern)
{
    size_t length;
    int digits;
    return find_number(pattern, &length, &digits) != NULL;
}

char *fl_output_name(const char *pattern, int number, const char *region, GError **error)
{
    static const char region_word[] = "{region}";
    size_t length = 0;
    int digits = 0;
    const char *place = find_number(pattern, &length, &digits);
    g_autoptr(GString) name = g_string_new(NULL);
    for (const char *at = pattern; *at;) {
        if (at == place) {
            g_string_append_printf(name, "%0*d", digits, number);
            at += length;
        } else if (g_str_has_prefix(at, "%%")) {
            g_string_append_c(name, '%');
            at += 2;
        } else if (*at == '%') {
            g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                        "%s: \"%.4s\" is not understood; expected one %%04d or #### for the frame "
                        "number, and %%%% for a percent sign",
                        pattern, at);
            return NULL;
        } else if (g_str_has_prefix(at, region_word) && region) {
            g_string_append(name, region);
            at += sizeof region_word - 1;
        } else if (g_str_has_prefix(at, region_word)) {
            g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                        "%s: {region} has no meaning here; it belongs in the name of layers",
                        pattern);
            return NULL;
        } else {
            g_string_append_c(name, *at++);
        }
    }
    return g_string_free(g_steal_pointer(&name), FALSE);
}

char *fl_output_of_film(const char *pattern, const char *film)
{
    g_auto(GStrv) parts = g_strsplit(pattern, "{name}", -1);
    return g_strjoinv(film, parts);
}
