#include "svg/path_data.h"

#include "svg/css_scan.h"
#include <string.h>

static const char *skip_comma(const char *s)
{
    s = fl_css_space(s);
    return *s == ',' ? fl_css_space(s + 1) : s;
}

/** Skips the arguments of one command, reading them into v; NULL if they are wrong. Flags of arcs
 * are single digits. */
static const char *arguments(const char *s, char command, int count, double *v)
{
    for (int i = 0; i < count; i++) {
        s = i ? skip_comma(s) : s;
        const bool flag = g_ascii_toupper(command) == 'A' && (i == 3 || i == 4);
        if (flag && *s != '0' && *s != '1')
            return NULL;
        if (flag)
            v[i] = *s++ - '0';
        else if (!fl_number_read(&s, &v[i]))
            return NULL;
    }
    return s;
}

const char *fl_path_data_walk(const char *d, FlPathStep *step, void *data)
{
    static const char commands[] = "MLHVCSQTAZ";
    static const int counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};
    double v[7] = {0};
    const char *s = fl_css_space(d);
    if (strncmp(s, "none", 4) == 0 && !*fl_css_space(s + 4))
        return NULL;
    for (bool first = true; *s; first = false) {
        const char *known = strchr(commands, g_ascii_toupper(*s));
        if (!known || (first && g_ascii_toupper(*s) != 'M'))
            return s;
        char command = *s;
        const int count = counts[known - commands];
        s = fl_css_space(s + 1);
        if (count == 0)
            step(data, command, v);
        for (bool more = count > 0; more;) {
            const char *next = arguments(s, command, count, v);
            if (!next)
                return s;
            step(data, command, v);
            if (g_ascii_toupper(command) == 'M')
                command = (char)(command - 1); // further pairs after a move are lines
            s = fl_css_space(next);
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
