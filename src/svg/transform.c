#include "svg/transform.h"

#include <glib.h>
#include <math.h>
#include <string.h>

#define MOST_ARGUMENTS 16

/** A function as it is read: its name, and arguments in px, degrees or plain numbers. */
typedef struct Call {
    const char *name;
    size_t length;
    double v[MOST_ARGUMENTS];
    int n;
} Call;

/** The factor of a unit; 0 if it is unknown. */
static double unit_of(const char *s, size_t n)
{
    static const struct {
        const char *name;
        double factor;
    } units[] = {{"", 1}, {"px", 1}, {"deg", 1}, {"rad", 180 / G_PI}, {"grad", 0.9}, {"turn", 360}};
    for (size_t k = 0; k < G_N_ELEMENTS(units); k++)
        if (strlen(units[k].name) == n && g_ascii_strncasecmp(s, units[k].name, n) == 0)
            return units[k].factor;
    return 0;
}

/** Skips one function. Returns: NULL if no function begins here. */
static const char *read_call(const char *s, Call *call)
{
    *call = (Call){.name = s};
    while (g_ascii_isalnum(*s))
        s++;
    call->length = (size_t)(s - call->name);
    s += strspn(s, " \t\r\n\f");
    if (call->length == 0 || *s != '(')
        return NULL;
    s += 1 + strspn(s + 1, " \t\r\n\f");
    while (*s && *s != ')') {
        char *end;
        if (call->n == MOST_ARGUMENTS)
            return NULL;
        const double v = g_ascii_strtod(s, &end);
        if (end == s)
            return NULL;
        s = end;
        while (g_ascii_isalpha(*s) || *s == '%')
            s++;
        const double unit = unit_of(end, (size_t)(s - end));
        if (unit <= 0 || !isfinite(v * unit))
            return NULL;
        call->v[call->n++] = v * unit;
        s += strspn(s, " \t\r\n\f,");
    }
    return *s ? s + 1 : NULL;
}

static bool is_called(const Call *call, const char *name)
{
    return strlen(name) == call->length && g_ascii_strncasecmp(name, call->name, call->length) == 0;
}

static double tangent(double degrees)
{
    double s, c;
    fl_sincos_degrees(degrees, &s, &c);
    return s / c;
}

static FlAffine rotation_about(double degrees, double x, double y)
{
    const FlAffine there = {1, 0, 0, 1, x, y}, back = {1, 0, 0, 1, -x, -y};
    const FlAffine turn = fl_affine_rotation(degrees), on = fl_affine_multiply(&there, &turn);
    return fl_affine_multiply(&on, &back);
}

/** The matrix of a function; false if it is unknown or has a wrong number of arguments. */
static bool map_of(const Call *call, FlAffine *m)
{
    const double *v = call->v;
    const int n = call->n;
    if (is_called(call, "matrix") && n == 6)
        *m = (FlAffine){v[0], v[1], v[2], v[3], v[4], v[5]};
    else if (is_called(call, "translate") && (n == 1 || n == 2))
        *m = (FlAffine){1, 0, 0, 1, v[0], n > 1 ? v[1] : 0};
    else if (is_called(call, "translateX") && n == 1)
        *m = (FlAffine){1, 0, 0, 1, v[0], 0};
    else if (is_called(call, "translateY") && n == 1)
        *m = (FlAffine){1, 0, 0, 1, 0, v[0]};
    else if (is_called(call, "scale") && (n == 1 || n == 2))
        *m = (FlAffine){v[0], 0, 0, n > 1 ? v[1] : v[0], 0, 0};
    else if (is_called(call, "scaleX") && n == 1)
        *m = (FlAffine){v[0], 0, 0, 1, 0, 0};
    else if (is_called(call, "scaleY") && n == 1)
        *m = (FlAffine){1, 0, 0, v[0], 0, 0};
    else if (is_called(call, "rotate") && n == 1)
        *m = fl_affine_rotation(v[0]);
    else if (is_called(call, "rotate") && n == 3)
        *m = rotation_about(v[0], v[1], v[2]);
    else if (is_called(call, "skewX") && n == 1)
        *m = (FlAffine){1, 0, tangent(v[0]), 1, 0, 0};
    else if (is_called(call, "skewY") && n == 1)
        *m = (FlAffine){1, tangent(v[0]), 0, 1, 0, 0};
    else if (is_called(call, "skew") && (n == 1 || n == 2))
        *m = (FlAffine){1, n > 1 ? tangent(v[1]) : 0, tangent(v[0]), 1, 0, 0};
    else
        return false;
    return true;
}

bool fl_affine_parse(const char *text, FlAffine *m)
{
    FlAffine all = FL_AFFINE_NONE;
    *m = FL_AFFINE_NONE;
    const char *s = text + strspn(text, " \t\r\n\f");
    if (strncmp(s, "none", 4) == 0)
        return true;
    while (*s) {
        Call call;
        FlAffine one;
        s = read_call(s, &call);
        if (!s || !map_of(&call, &one))
            return false;
        all = fl_affine_multiply(&all, &one);
        s += strspn(s, " \t\r\n\f,");
    }
    *m = all;
    return true;
}

/* ---- CSS ------------------------------------------------------------------------------------- */

/** The part in the plane of a rotation about an axis in space; false for an axis of no length. */
static bool rotation_in_space(double x, double y, double z, double degrees, FlAffine *m)
{
    double s, c;
    const double length = sqrt(x * x + y * y + z * z);
    if (!(length > 0))
        return false;
    x /= length, y /= length, z /= length;
    fl_sincos_degrees(degrees, &s, &c);
    *m = (FlAffine){x * x * (1 - c) + c,
                    x * y * (1 - c) + z * s,
                    x * y * (1 - c) - z * s,
                    y * y * (1 - c) + c,
                    0,
                    0};
    return true;
}

/** The matrix of a function in space; false if it is unknown. */
static bool map_of_space(const char *name, const double *v, int n, FlAffine *m)
{
#define IS(word, count) (strcmp(name, word) == 0 && n == (count))
    if (IS("translate3d", 3))
        *m = (FlAffine){1, 0, 0, 1, v[0], v[1]};
    else if (IS("scale3d", 3))
        *m = (FlAffine){v[0], 0, 0, v[1], 0, 0};
    else if (IS("translatez", 1) || IS("scalez", 1) || IS("perspective", 1))
        *m = FL_AFFINE_NONE;
    else if (IS("rotatez", 1))
        *m = fl_affine_rotation(v[0]);
    else if (IS("rotatex", 1))
        return rotation_in_space(1, 0, 0, v[0], m);
    else if (IS("rotatey", 1))
        return rotation_in_space(0, 1, 0, v[0], m);
    else if (IS("rotate3d", 4))
        return rotation_in_space(v[0], v[1], v[2], v[3], m);
    else if (IS("matrix3d", 16))
        *m = (FlAffine){v[0], v[1], v[4], v[5], v[12], v[13]};
    else
        return false;
    return true;
#undef IS
}

/** Reads the arguments of one function and its matrix. */
static bool map_of_css(const char *name, const char *arguments, const FlCssUnits *units,
                       FlAffine *m)
{
    g_auto(GStrv) part = fl_css_split(arguments, ',');
    g_autofree char *lower = g_ascii_strdown(name, -1);
    const bool vertical = g_str_has_suffix(lower, "y");
    double v[MOST_ARGUMENTS];
    const int n = (int)g_strv_length(part);
    if (n > MOST_ARGUMENTS)
        return false;
    for (int i = 0; i < n; i++) {
        const bool length = g_str_has_prefix(lower, "translate");
        const double whole = !length ? 1 : i == 1 || vertical ? units->height : units->width;
        if (strcmp(part[i], "none") == 0) // perspective(none)
            v[i] = 0;
        else if (!fl_css_number(part[i], units, whole, &v[i]))
            return false;
    }
    if (map_of_space(lower, v, n, m))
        return true;
    Call call = {.name = name, .length = strlen(name), .n = n};
    memcpy(call.v, v, sizeof v);
    return map_of(&call, m);
}

bool fl_affine_parse_css(const char *text, const FlCssUnits *units, FlAffine *m)
{
    *m = FL_AFFINE_NONE;
    FlAffine all = FL_AFFINE_NONE;
    const char *s = fl_css_space(text);
    if (strcmp(s, "none") == 0)
        return true;
    while (*s) {
        const char *open = s + fl_css_identifier(s);
        const char *close = *open == '(' ? fl_css_find(open + 1, ")") : open;
        g_autofree char *name = g_strndup(s, (gsize)(open - s));
        if (*open != '(' || *close != ')')
            return false;
        g_autofree char *arguments = g_strndup(open + 1, (gsize)(close - open) - 1);
        FlAffine one;
        if (!map_of_css(name, arguments, units, &one))
            return false;
        all = fl_affine_multiply(&all, &one);
        s = fl_css_space(close + 1);
    }
    *m = all;
    return true;
}

FlAffine fl_affine_of(const xmlNode *node)
{
    FlAffine m = FL_AFFINE_NONE;
    g_autoptr(xmlChar) text = fl_attribute(node, "transform");
    if (text)
        fl_affine_parse((const char *)text, &m);
    return m;
}
