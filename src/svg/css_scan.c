#include "svg/css_scan.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

const char *fl_css_space(const char *s)
{
    return s + strspn(s, FL_CSS_SPACE);
}

bool fl_css_has_word(const char *text, const char *word)
{
    const size_t n = strcspn(word, FL_CSS_SPACE);
    for (const char *at = text; n > 0 && !word[n] && (at = strstr(at, word)); at++)
        if ((at == text || strchr(FL_CSS_SPACE, at[-1])) && (!at[n] || strchr(FL_CSS_SPACE, at[n])))
            return true;
    return false;
}

/** Skips digits and appends them to a number. Returns: how many there are. */
static size_t skip_digits(const char **s, uint64_t *number)
{
    const char *start = *s;
    for (; g_ascii_isdigit(**s); (*s)++)
        *number = *number * 10 + (uint64_t)(**s - '0');
    return (size_t)(*s - start);
}

bool fl_number_read(const char **text, double *value)
{
    static const double tens[] = {1,   1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                                  1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
    const char *s = *text + (**text == '+' || **text == '-');
    uint64_t digits = 0;
    const size_t before = skip_digits(&s, &digits);
    const bool point = *s == '.';
    s += point;
    const size_t after = point ? skip_digits(&s, &digits) : 0;
    if (point ? after == 0 : before == 0) // strtod would read "inf", "1." and "0x1"
        return false;
    double read = (**text == '-' ? -1 : 1) * (double)digits;
    const size_t sign = (*s == 'e' || *s == 'E') && (s[1] == '+' || s[1] == '-');
    const bool exponent = (*s == 'e' || *s == 'E') && g_ascii_isdigit(s[1 + sign]);
    if (exponent)
        s += 1 + sign + strspn(s + 1 + sign, "0123456789");
    if (exponent || before + after > 15)
        read = g_ascii_strtod(*text, NULL);
    else
        read /= tens[after]; // exact, and several times as fast
    if (!isfinite(read))
        return false;
    *value = read;
    *text = s;
    return true;
}

int fl_numbers_read(const char *text, double *v, int most)
{
    int n = 0;
    bool comma = false;
    for (const char *s = text + strspn(text, FL_CSS_SPACE); *s || comma;) {
        if (n == most || !fl_number_read(&s, &v[n++]))
            return -1;
        s += strspn(s, FL_CSS_SPACE);
        comma = *s == ',';
        s += comma ? 1 + strspn(s + 1, FL_CSS_SPACE) : 0;
    }
    return n;
}

/** Skips a string with its quotes. */
static const char *skip_string(const char *s)
{
    const char quote = *s++;
    while (*s && *s != quote)
        s += *s == '\\' && s[1] ? 2 : 1;
    return *s ? s + 1 : s;
}

const char *fl_css_find(const char *s, const char *stops)
{
    int depth = 0;
    while (*s) {
        if (depth == 0 && strchr(stops, *s))
            return s;
        if (*s == '"' || *s == '\'') {
            s = skip_string(s);
        } else if (*s == '\\' && s[1]) {
            s += 2;
        } else {
            if (strchr("([{", *s))
                depth++;
            else if (strchr(")]}", *s) && depth-- == 0)
                return s;
            s++;
        }
    }
    return s;
}

const char *fl_css_find_past(const char *s, const char *stops)
{
    s = fl_css_find(s, stops);
    while (*s && !strchr(stops, *s))
        s = fl_css_find(s + 1, stops);
    return s;
}

/** The bytes of an escape, from its backslash on: a character, or up to six digits and a space. */
static size_t escape_bytes(const char *s)
{
    size_t n = 1;
    while (n <= 6 && g_ascii_isxdigit(s[n]))
        n++;
    return n == 1 ? 2 : n + (s[n] && strchr(FL_CSS_SPACE, s[n]));
}

size_t fl_css_identifier(const char *s)
{
    size_t n = 0;
    while (g_ascii_isalnum(s[n]) || s[n] == '-' || s[n] == '_' || (guchar)s[n] >= 0x80 ||
           (s[n] == '\\' && s[n + 1] && s[n + 1] != '\n'))
        n += s[n] == '\\' ? escape_bytes(s + n) : 1;
    const bool starts = n > 0 && !g_ascii_isdigit(s[0]) && !(s[0] == '-' && n == 1);
    return starts ? n : 0;
}

/** Resolves the escape after a backslash. Returns: the text behind the escape. */
static const char *unescape_one(GString *out, const char *s, const char *end)
{
    gunichar code = 0;
    int digits = 0;
    for (; digits < 6 && s < end && g_ascii_isxdigit(*s); digits++)
        code = code * 16 + (gunichar)g_ascii_xdigit_value(*s++);
    if (digits == 0) {
        g_string_append_c(out, *s);
        return s + 1;
    }
    g_string_append_unichar(out, code && g_unichar_validate(code) ? code : 0xfffd);
    return s < end && strchr(FL_CSS_SPACE, *s) ? s + 1 : s;
}

char *fl_css_unescape(const char *s, size_t n)
{
    GString *out = g_string_sized_new(n);
    for (const char *end = s + n; s < end;)
        if (*s == '\\' && s + 1 < end)
            s = unescape_one(out, s + 1, end);
        else
            g_string_append_c(out, *s++);
    return g_string_free(out, FALSE);
}

char *fl_css_without_comments(const char *css)
{
    GString *out = g_string_new(NULL);
    while (*css) {
        const char *next = css + 1;
        if (*css == '"' || *css == '\'') {
            next = skip_string(css);
            g_string_append_len(out, css, next - css);
        } else if (css[0] == '/' && css[1] == '*') {
            const char *end = strstr(css + 2, "*/");
            next = end ? end + 2 : css + strlen(css);
            if (!*next || !strchr(".#[:", *next)) // a space there would combine two selectors
                g_string_append_c(out, ' ');
        } else if (g_str_has_prefix(css, "<!--") || g_str_has_prefix(css, "-->")) {
            next = css + (*css == '<' ? 4 : 3);
            g_string_append_c(out, ' ');
        } else {
            g_string_append_c(out, *css);
        }
        css = next;
    }
    return g_string_free(out, FALSE);
}

char **fl_css_split(const char *text, char separator)
{
    GPtrArray *parts = g_ptr_array_new();
    const char one[] = {separator, '\0'}, *stops = separator == ' ' ? FL_CSS_SPACE : one;
    for (const char *s = fl_css_space(text); *s;) {
        const char *end = fl_css_find_past(s, stops);
        char *part = g_strstrip(g_strndup(s, (gsize)(end - s)));
        if (*part)
            g_ptr_array_add(parts, part);
        else
            g_free(part);
        s = *end ? fl_css_space(end + 1) : end;
    }
    g_ptr_array_add(parts, NULL);
    return (char **)g_ptr_array_free(parts, FALSE);
}

bool fl_css_call(const char *text, char **name, char **arguments)
{
    text = fl_css_space(text);
    const size_t n = fl_css_identifier(text);
    if (n == 0 || text[n] != '(')
        return false;
    const char *end = fl_css_find(text + n + 1, ")");
    if (*end != ')' || *fl_css_space(end + 1))
        return false;
    *name = g_ascii_strdown(text, (gssize)n);
    *arguments = g_strstrip(g_strndup(text + n + 1, (gsize)(end - text) - n - 1));
    return true;
}

char *fl_css_string_or_url(const char *text)
{
    g_autofree char *name = NULL, *inside = NULL;
    text = fl_css_space(text);
    if (fl_css_call(text, &name, &inside) && strcmp(name, "url") != 0)
        return NULL;
    const char *s = inside ? inside : text;
    if (*s != '"' && *s != '\'')
        return inside ? fl_css_unescape(inside, strlen(inside)) : NULL;
    const char *end = skip_string(s);
    return end - s < 2 ? NULL : fl_css_unescape(s + 1, (size_t)(end - s) - 2);
}

char *fl_css_take_url(const char **s)
{
    const char *open = strchr(*s, '('), *close = fl_css_find(open ? open + 1 : *s, ")");
    g_autofree char *call = g_strdup_printf("%.*s)", (int)(close - *s), *s);
    *s = *close ? close + 1 : close;
    return fl_css_string_or_url(call);
}
