#include "svg/path_data.h"

#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <string.h>

static const char *skip_space(const char *s)
{
    return s + strspn(s, " \t\r\n\f");
}

static const char *skip_comma(const char *s)
{
    s = skip_space(s);
    return *s == ',' ? skip_space(s + 1) : s;
}

/** Skips a number. Returns: NULL without a number. Does not use strtod, which accepts "inf" and
 * "0x1". */
static const char *number(const char *s)
{
    if (*s == '+' || *s == '-')
        s++;
    const size_t before = strspn(s, "0123456789");
    s += before;
    size_t after = 0;
    if (*s == '.') {
        after = strspn(s + 1, "0123456789");
        s += 1 + after;
    }
    if (after == 0 && (before == 0 || s[-1] == '.'))
        return NULL;
    if ((*s == 'e' || *s == 'E') && s[1]) {
        const char *e = s + 1 + (s[1] == '+' || s[1] == '-');
        if (g_ascii_isdigit(*e))
            s = e + strspn(e, "0123456789");
    }
    return s;
}

/** Skips the arguments of one command, reading them into v; NULL if they are wrong. Flags of arcs
 * are single digits. */
static const char *arguments(const char *s, char command, int count, double *v)
{
    for (int i = 0; i < count; i++) {
        s = i ? skip_comma(s) : s;
        const bool flag = g_ascii_toupper(command) == 'A' && (i == 3 || i == 4);
        const char *end = !flag ? number(s) : *s == '0' || *s == '1' ? s + 1 : NULL;
        if (!end)
            return NULL;
        v[i] = flag ? *s - '0' : g_ascii_strtod(s, NULL);
        if (!isfinite(v[i]))
            return NULL;
        s = end;
    }
    return s;
}

const char *fl_path_data_walk(const char *d, FlPathStep *step, void *data)
{
    static const char commands[] = "MLHVCSQTAZ";
    static const int counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
    double v[7] = {0};
    const char *s = skip_space(d);
    if (strncmp(s, "none", 4) == 0 && !*skip_space(s + 4))
        return NULL;
    for (bool first = true; *s; first = false) {
        const char *known = strchr(commands, g_ascii_toupper(*s));
        if (!known || (first && g_ascii_toupper(*s) != 'M'))
            return s;
        char command = *s;
        const int count = counts[known - commands];
        s = skip_space(s + 1);
        if (count == 0)
            step(data, command, v);
        for (bool more = count > 0; more;) {
            const char *next = arguments(s, command, count, v);
            if (!next)
                return s;
            step(data, command, v);
            if (g_ascii_toupper(command) == 'M')
                command = (char)(command - 1); // further pairs after a move are lines
            s = skip_space(next);
            more = *s && (*s == ',' || !g_ascii_isalpha(*s));
            s = more ? skip_comma(s) : s;
        }
    }
    return NULL;
}

static void ignore(void *data, char command, const double *v)
{
    (void)data, (void)command, (void)v;
}

const char *fl_path_data_error(const char *d)
{
    return fl_path_data_walk(d, ignore, NULL);
}
