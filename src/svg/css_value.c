#include "svg/css_value.h"

#include "svg/affine.h"
#include <math.h>
#include <string.h>

#define LARGEST_BYTES 65536
#define MOST_NESTED 32

/* ---- variables ------------------------------------------------------------------------------- */

static bool substitute(GString *out, const char *value, FlCssVariable *variable, const void *data,
                       int depth);

/** Appends the value of var(--name, fallback) from its arguments. */
static bool append_variable(GString *out, const char *arguments, FlCssVariable *variable,
                            const void *data, int depth)
{
    const char *comma = fl_css_find(arguments, ",");
    g_autofree char *written = g_strndup(arguments, (gsize)(comma - arguments));
    g_autofree char *name = fl_css_unescape(g_strstrip(written), strlen(written));
    const char *known = variable(data, name);
    if (known) {
        const gsize before = out->len;
        if (substitute(out, known, variable, data, depth + 1))
            return true;
        g_string_truncate(out, before);
    }
    return *comma && substitute(out, fl_css_space(comma + 1), variable, data, depth + 1);
}

/** The first call of var() or env() outside strings; NULL if there is no call. */
static const char *find_variable(const char *s)
{
    for (; *s; s++) {
        if (*s == '"' || *s == '\'') {
            const char *end = strchr(s + 1, *s);
            s = end ? end : s + strlen(s) - 1;
        } else if (g_ascii_strncasecmp(s, "var(", 4) == 0 || g_ascii_strncasecmp(s, "env(", 4) == 0)
            return s;
    }
    return NULL;
}

static bool substitute(GString *out, const char *value, FlCssVariable *variable, const void *data,
                       int depth)
{
    if (depth > MOST_NESTED)
        return false;
    for (const char *call; (call = find_variable(value));) {
        const char *end = fl_css_find(call + 4, ")");
        g_autofree char *arguments = g_strndup(call + 4, (gsize)(end - call) - 4);
        g_string_append_len(out, value, call - value);
        if (*end != ')' || !append_variable(out, arguments, variable, data, depth))
            return false;
        value = end + 1;
    }
    g_string_append(out, value);
    return out->len <= LARGEST_BYTES;
}

char *fl_css_substitute(const char *value, FlCssVariable *variable, const void *data)
{
    GString *out = g_string_new(NULL);
    const bool good = substitute(out, value, variable, data, 0);
    return g_string_free(out, !good);
}

/* ---- numbers --------------------------------------------------------------------------------- */

typedef struct Calc {
    const FlCssUnits *units;
    double whole;
    int depth;
    int *kind; // of what was read last; 0: a word
} Calc;

static bool read_sum(const Calc *calc, const char **s, double *value);

/** The factor of a unit of n bytes, and what it measures; 0 if it is unknown. */
static double unit_factor(const Calc *calc, const char *unit, size_t n)
{
    const FlCssUnits *u = calc->units;
    const double inch = u->dpi > 0 ? u->dpi : 96;
    const struct {
        const char *name;
        double factor;
        int kind; // 0: a length
    } known[] = {
        {"px", 1},
        {"%", calc->whole / 100, FL_CSS_SHARE},
        {"em", u->font_size},
        {"rem", u->root_font_size},
        {"ex", u->font_size / 2},
        {"ch", u->font_size / 2},
        {"lh", u->font_size * 1.2},
        {"vw", u->page_width / 100},
        {"vh", u->page_height / 100},
        {"vi", u->page_width / 100},
        {"vb", u->page_height / 100},
        {"vmin", MIN(u->page_width, u->page_height) / 100},
        {"vmax", MAX(u->page_width, u->page_height) / 100},
        {"in", inch},
        {"cm", inch / 2.54},
        {"mm", inch / 25.4},
        {"q", inch / 101.6},
        {"pt", inch / 72},
        {"pc", inch / 6},
        {"deg", 1, FL_CSS_ANGLE},
        {"rad", 180 / G_PI, FL_CSS_ANGLE},
        {"grad", 0.9, FL_CSS_ANGLE},
        {"turn", 360, FL_CSS_ANGLE},
        {"s", 1, FL_CSS_OTHER},
        {"ms", 0.001, FL_CSS_OTHER},
        {"dppx", 1, FL_CSS_OTHER},
        {"x", 1, FL_CSS_OTHER},
        {"fr", 1, FL_CSS_OTHER},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(known); i++)
        if (strlen(known[i].name) == n && g_ascii_strncasecmp(known[i].name, unit, n) == 0) {
            *calc->kind = known[i].kind ? known[i].kind : FL_CSS_SIZE;
            return known[i].factor;
        }
    *calc->kind = 0;
    // svw, lvh, dvmin … are the same on a page without bars
    return n > 2 && strchr("sldSLD", *unit) && unit[1] == 'v' ? unit_factor(calc, unit + 1, n - 1)
                                                              : 0;
}

/** Returns: false if two values cannot be added; percentages can, to lengths and to numbers. */
static bool join_kinds(int *kind, int other)
{
    const int all = *kind | other;
    if (*kind && other && *kind != other && all != (FL_CSS_SIZE | FL_CSS_SHARE) &&
        all != (FL_CSS_PLAIN | FL_CSS_SHARE))
        return false;
    *kind = all & FL_CSS_SHARE ? FL_CSS_SHARE : all;
    return true;
}

/** Reads comma-separated arguments up to the bracket; their number, -1 if they are wrong. */
static int read_arguments(const Calc *calc, const char **s, double *values, int most)
{
    int n = 0, kind = 0;
    for (*s = fl_css_space(*s); **s && **s != ')'; *s = fl_css_space(*s)) {
        if (n == most || !read_sum(calc, s, &values[n++]) || !join_kinds(&kind, *calc->kind))
            return -1;
        *s = fl_css_space(*s);
        if (**s == ',')
            (*s)++;
        else if (**s != ')')
            return -1;
    }
    if (**s != ')')
        return -1;
    (*s)++;
    *calc->kind = kind;
    return n;
}

static double least(const double *v, int n, bool largest)
{
    double found = v[0];
    for (int i = 1; i < n; i++)
        found = largest ? MAX(found, v[i]) : MIN(found, v[i]);
    return found;
}

static double sine(double degrees, bool cosine)
{
    double s, c;
    fl_sincos_degrees(degrees, &s, &c);
    return cosine ? c : s;
}

/** A mathematical function; false if it is unknown or has a wrong number of arguments. */
static bool apply(const char *name, const double *v, int n, double *value)
{
    const bool one = n == 1, two = n == 2;
#define IS(word, count) (strcmp(name, word) == 0 && (count))
    if (IS("calc", one) || IS("-webkit-calc", one))
        *value = v[0];
    else if (IS("min", n > 0) || IS("max", n > 0))
        *value = least(v, n, name[1] == 'a');
    else if (IS("clamp", n == 3))
        *value = MAX(v[0], MIN(v[1], v[2]));
    else if (IS("abs", one))
        *value = fabs(v[0]);
    else if (IS("sign", one))
        *value = (v[0] > 0) - (v[0] < 0);
    else if (IS("round", one || two || n == 3)) {
        const int first = n == 3;
        const double way = first ? v[0] : 0;
        const double step = one ? 1 : v[first + 1], at = v[first] / step;
        *value = step * (way == 0   ? floor(at + .5)
                         : way == 1 ? ceil(at)
                         : way == 2 ? floor(at)
                                    : trunc(at));
    } else if (IS("mod", two))
        *value = v[0] - v[1] * floor(v[0] / v[1]);
    else if (IS("rem", two))
        *value = fmod(v[0], v[1]);
    else if (IS("sin", one) || IS("cos", one))
        *value = sine(v[0], name[0] == 'c');
    else if (IS("tan", one))
        *value = sine(v[0], false) / sine(v[0], true);
    else if (IS("sqrt", one))
        *value = sqrt(v[0]);
    else if (IS("pow", two))
        *value = pow(v[0], v[1]);
    else if (IS("exp", one))
        *value = exp(v[0]);
    else if (IS("hypot", n > 0)) {
        double sum = 0;
        for (int i = 0; i < n; i++)
            sum += v[i] * v[i];
        *value = sqrt(sum);
    } else
        return false;
#undef IS
    return true;
}

/** Reads "name(…)", "(…)" or a constant. */
static bool read_call(const Calc *calc, const char **s, double *value)
{
    double v[8];
    const size_t n = fl_css_identifier(*s);
    g_autofree char *name = n ? g_ascii_strdown(*s, (gssize)n) : g_strdup("calc");
    const Calc inner = {calc->units, calc->whole, calc->depth + 1, calc->kind};
    *s += n;
    if (**s != '(') {
        static const char *const ways[] = {"nearest", "up", "down", "to-zero"}; // of round()
        *value = strcmp(name, "pi") == 0 ? G_PI : strcmp(name, "e") == 0 ? G_E : NAN;
        *calc->kind = isfinite(*value) ? FL_CSS_PLAIN : 0;
        for (size_t i = 0; calc->depth > 0 && i < G_N_ELEMENTS(ways); i++)
            *value = strcmp(name, ways[i]) == 0 ? (double)i : *value;
        return isfinite(*value);
    }
    (*s)++;
    const int count = calc->depth < MOST_NESTED ? read_arguments(&inner, s, v, 8) : -1;
    if (fl_css_has_word("sign sin cos tan", name))
        *calc->kind = FL_CSS_PLAIN;
    return count >= 0 && apply(name, v, count, value);
}

/** Reads a number with its unit, or a call. */
static bool read_term(const Calc *calc, const char **s, double *value)
{
    *s = fl_css_space(*s);
    const char *digits = *s + (**s == '-' || **s == '+');
    if (!g_ascii_isdigit(*digits) && *digits != '.')
        return read_call(calc, s, value);
    const char *end = *s;
    if (!fl_number_read(&end, value))
        return false;
    const size_t n =
        *end == '%' ? 1 : strspn(end, "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ");
    *calc->kind = FL_CSS_PLAIN;
    *value *= n ? unit_factor(calc, end, n) : 1;
    *s = end + n;
    return *calc->kind;
}

static bool read_product(const Calc *calc, const char **s, double *value)
{
    if (!read_term(calc, s, value))
        return false;
    for (;;) {
        const char *at = fl_css_space(*s);
        const int kind = *calc->kind;
        double next;
        if (*at != '*' && *at != '/')
            return true;
        *s = at + 1;
        if (!read_term(calc, s, &next))
            return false;
        if (*at == '/' && *calc->kind == kind)
            *calc->kind = FL_CSS_PLAIN;
        else if (*calc->kind == FL_CSS_PLAIN)
            *calc->kind = kind;
        else if (kind != FL_CSS_PLAIN)
            return false;
        *value = *at == '*' ? *value * next : *value / next;
    }
}

/** A sum needs space around its sign. */
static bool read_sum(const Calc *calc, const char **s, double *value)
{
    if (!read_product(calc, s, value))
        return false;
    for (;;) {
        const char *at = fl_css_space(*s);
        int kind = *calc->kind;
        double next;
        if (at == *s || (*at != '+' && *at != '-') || !strchr(FL_CSS_SPACE, at[1]))
            return true;
        *s = at + 1;
        if (!read_product(calc, s, &next) || !join_kinds(&kind, *calc->kind))
            return false;
        *calc->kind = kind;
        *value += *at == '+' ? next : -next;
    }
}

bool fl_css_amount(const char *text, int kinds, const FlCssUnits *units, double whole,
                   double *value)
{
    int kind = 0;
    const Calc calc = {units, whole, 0, &kind};
    const char *s = text;
    if (!read_term(&calc, &s, value) || *fl_css_space(s) || !isfinite(*value))
        return false;
    const bool bare = kind == FL_CSS_PLAIN && (kinds & (FL_CSS_SIZE | FL_CSS_ANGLE));
    return (kind & kinds) || (bare && (units->bare || (*value == 0 && s[-1] != ')')));
}

bool fl_css_number(const char *text, const FlCssUnits *units, double whole, double *value)
{
    return fl_css_amount(text, ~0, units, whole, value);
}

char *fl_css_number_text(double value)
{
    char text[G_ASCII_DTOSTR_BUF_SIZE];
    return g_strdup(g_ascii_formatd(text, sizeof text, "%.9g", value));
}
