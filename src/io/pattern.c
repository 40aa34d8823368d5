#include "io/pattern.h"

#include <string.h>

#define MOST_DIGITS 9 // so that a number fits an int

void fl_pattern_clear(FlPattern *pattern)
{
    g_clear_pointer(&pattern->prefix, g_free);
    g_clear_pointer(&pattern->suffix, g_free);
}

/** Length of the conversion "%d" or "%04d" at s, 0 if there is none; its width goes to *width. */
static size_t conversion(const char *s, int *width)
{
    size_t n = 1;
    while (g_ascii_isdigit(s[n]))
        n++;
    if (s[0] != '%' || s[n] != 'd' || n > 3)
        return 0;
    const int digits = (int)g_ascii_strtoll(s + 1, NULL, 10);
    *width = CLAMP(digits, 1, MOST_DIGITS);
    return n + 1;
}

/** Reads name into the text before and after the number. Returns: numbers found, -1 on an error. */
static int split(const char *name, GString *text[3], int *width, GError **error)
{
    int part = 0;
    for (const char *s = name; *s;) {
        const size_t n = *s == '#' ? strspn(s, "#") : conversion(s, width);
        if (s[0] == '%' && s[1] == '%') {
            g_string_append_c(text[part], '%');
            s += 2;
        } else if (n > 0) {
            if (*s == '#')
                *width = (int)MIN(n, MOST_DIGITS);
            part = MIN(part + 1, 2);
            s += n;
        } else if (*s == '%') {
            g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                        "%s: \"%.3s\" is no frame number; expected %%d, %%04d or ####", name, s);
            return -1;
        } else {
            g_string_append_c(text[part], *s++);
        }
    }
    if (part == 2) {
        g_set_error(error, FL_ERROR, FL_ERROR_USAGE,
                    "%s: two places for the frame number; expected one", name);
        return -1;
    }
    return part;
}

bool fl_pattern_parse(const char *name, FlPattern *pattern, bool *has_number, GError **error)
{
    GString *text[3] = {g_string_new(NULL), g_string_new(NULL), g_string_new(NULL)};
    int width = 1;
    const int numbers = split(name, text, &width, error);
    *has_number = numbers == 1;
    *pattern = (FlPattern){0};
    if (*has_number)
        *pattern = (FlPattern){g_strdup(text[0]->str), g_strdup(text[1]->str), width};
    for (int i = 0; i < 3; i++)
        g_string_free(text[i], TRUE);
    return numbers >= 0;
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
    if (strspn(digits, "0123456789") < n || n > MOST_DIGITS || n < (size_t)pattern->width)
        return false;
    if (pattern->width > 1 && n > (size_t)pattern->width && digits[0] == '0')
        return false; // a_00001.svg is not of a_%04d.svg
    *number = (int)g_ascii_strtoll(digits, NULL, 10);
    return true;
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

char *fl_pattern_text(const FlPattern *pattern)
{
    if (pattern->width == 1)
        return g_strdup_printf("%s%%d%s", pattern->prefix, pattern->suffix);
    return g_strdup_printf("%s%%0%dd%s", pattern->prefix, pattern->width, pattern->suffix);
}
