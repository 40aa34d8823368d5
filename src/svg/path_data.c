#include "svg/path_data.h"

#include "svg/css_value.h"
#include <string.h>

static const char commands[] = "MLHVCSQTAZ";
static const int counts[] = {2, 2, 1, 1, 6, 4, 4, 2, 7, 0};

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

/** Path data with absolute coordinates. */
typedef struct Absolute {
    GString *command; // of each step
    GArray *number;   // double: the arguments of all steps
    double at[2], start[2];
} Absolute;

static void add_step(void *data, char command, const double *v)
{
    Absolute *path = data;
    const char upper = g_ascii_toupper(command);
    double end[2] = {path->at[0], path->at[1]};
    for (int i = 0; i < counts[strchr(commands, upper) - commands]; i++) {
        const int axis = upper == 'V' ? 1 : upper == 'A' ? i - 5 : i % 2; // below 0: no coordinate
        const double number = v[i] + (command != upper && axis >= 0 ? path->at[axis] : 0);
        g_array_append_val(path->number, number);
        if (axis >= 0)
            end[axis] = number;
    }
    if (upper == 'M')
        memcpy(path->start, end, sizeof end);
    memcpy(path->at, upper == 'Z' ? path->start : end, sizeof end);
    g_string_append_c(path->command, upper);
}

char *fl_path_data_combine(const char *a, const char *b, double wa, double wb)
{
    g_autoptr(GString) steps_a = g_string_new(NULL), steps_b = g_string_new(NULL);
    g_autoptr(GArray) numbers_a = g_array_new(FALSE, FALSE, sizeof(double));
    g_autoptr(GArray) numbers_b = g_array_new(FALSE, FALSE, sizeof(double));
    if (fl_path_data_walk(a, add_step, &(Absolute){.command = steps_a, .number = numbers_a}) ||
        fl_path_data_walk(b, add_step, &(Absolute){.command = steps_b, .number = numbers_b}) ||
        steps_a->len == 0 || !g_string_equal(steps_a, steps_b))
        return NULL;
    GString *d = g_string_new(NULL);
    guint n = 0;
    for (const char *step = steps_a->str; *step; step++) {
        g_string_append_c(d, *step);
        for (int i = 0; i < counts[strchr(commands, *step) - commands]; i++, n++) {
            const double v =
                wa * g_array_index(numbers_a, double, n) + wb * g_array_index(numbers_b, double, n);
            const bool flag = *step == 'A' && (i == 3 || i == 4);
            g_autofree char *text = fl_css_number_text(flag ? v != 0 : v);
            g_string_append_printf(d, "%s%s", i ? " " : "", text);
        }
    }
    return g_string_free(d, FALSE);
}
