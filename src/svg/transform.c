#include "svg/transform.h"

#include "svg/css_scan.h"
#include <math.h>
#include <string.h>

#define MOST_ARGUMENTS 16

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

/** The matrix of a function in the plane; false if it is unknown or has a wrong number of
 * arguments.
 */
static bool map_of(const char *name, const double *v, int n, FlAffine *m)
{
#define IS(word, count) (g_ascii_strcasecmp(name, word) == 0 && (count))
    if (IS("matrix", n == 6))
        *m = (FlAffine){v[0], v[1], v[2], v[3], v[4], v[5]};
    else if (IS("translate", n == 1 || n == 2))
        *m = (FlAffine){1, 0, 0, 1, v[0], n > 1 ? v[1] : 0};
    else if (IS("translateX", n == 1))
        *m = (FlAffine){1, 0, 0, 1, v[0], 0};
    else if (IS("translateY", n == 1))
        *m = (FlAffine){1, 0, 0, 1, 0, v[0]};
    else if (IS("scale", n == 1 || n == 2))
        *m = (FlAffine){v[0], 0, 0, n > 1 ? v[1] : v[0], 0, 0};
    else if (IS("scaleX", n == 1))
        *m = (FlAffine){v[0], 0, 0, 1, 0, 0};
    else if (IS("scaleY", n == 1))
        *m = (FlAffine){1, 0, 0, v[0], 0, 0};
    else if (IS("rotate", n == 1))
        *m = fl_affine_rotation(v[0]);
    else if (IS("rotate", n == 3))
        *m = rotation_about(v[0], v[1], v[2]);
    else if (IS("skewX", n == 1))
        *m = (FlAffine){1, 0, tangent(v[0]), 1, 0, 0};
    else if (IS("skewY", n == 1))
        *m = (FlAffine){1, tangent(v[0]), 0, 1, 0, 0};
    else if (IS("skew", n == 1 || n == 2))
        *m = (FlAffine){1, n > 1 ? tangent(v[1]) : 0, tangent(v[0]), 1, 0, 0};
    else
        return false;
    return true;
#undef IS
}

/* ---- in space -------------------------------------------------------------------------------- */

/** A matrix of homogeneous coordinates in space, by rows. */
typedef struct Space {
    double m[4][4];
} Space;

static Space space_of(const FlAffine *plane)
{
    return (Space){{{plane->xx, plane->xy, 0, plane->x0},
                    {plane->yx, plane->yy, 0, plane->y0},
                    {0, 0, 1, 0},
                    {0, 0, 0, 1}}};
}

static Space multiply(const Space *a, const Space *b)
{
    Space product = {0};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 4; k++)
            for (int j = 0; j < 4; j++)
                product.m[i][k] += a->m[i][j] * b->m[j][k];
    return product;
}

/** A rotation about an axis; false for an axis of no length. */
static bool rotation_in_space(const double axis[3], double degrees, Space *space)
{
    double s, c;
    const double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]);
    if (!(length > 0))
        return false;
    fl_sincos_degrees(degrees, &s, &c);
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 3; k++) {
            const double cross = i == k ? 0 : axis[3 - i - k] / length;
            space->m[i][k] = axis[i] * axis[k] / (length * length) * (1 - c) + (i == k ? c : 0) +
                             ((k - i + 3) % 3 == 1 ? -s : s) * cross;
        }
    return true;
}

/** The matrix of a function in space; false if it is unknown. */
static bool map_of_space(const char *name, const double *v, int n, Space *space)
{
    const FlAffine none = FL_AFFINE_NONE;
    *space = space_of(&none);
#define IS(word, count) (strcmp(name, word) == 0 && n == (count))
    if (IS("translate3d", 3))
        space->m[0][3] = v[0], space->m[1][3] = v[1], space->m[2][3] = v[2];
    else if (IS("translatez", 1))
        space->m[2][3] = v[0];
    else if (IS("scale3d", 3))
        space->m[0][0] = v[0], space->m[1][1] = v[1], space->m[2][2] = v[2];
    else if (IS("scalez", 1))
        space->m[2][2] = v[0];
    else if (IS("perspective", 1))
        space->m[3][2] = v[0] > 0 ? -1 / fmax(v[0], 1) : 0;
    else if (IS("rotatez", 1) || IS("rotatex", 1) || IS("rotatey", 1))
        return rotation_in_space((double[]){name[6] == 'x', name[6] == 'y', name[6] == 'z'}, v[0],
                                 space);
    else if (IS("rotate3d", 4))
        return rotation_in_space(v, v[3], space);
    else if (IS("matrix3d", 16))
        for (int i = 0; i < 16; i++)
            space->m[i % 4][i / 4] = v[i];
    else
        return false;
    return true;
#undef IS
}

/** Returns: true if the i-th argument of a function of CSS is an angle, a length or a plain number,
 * as the function wants; 0 needs no unit, and results of calc() and the like are not checked. */
static bool has_right_unit(const char *name, int i, const char *text, double value)
{
    const char last = text[strlen(text) - 1];
    const bool plain = g_ascii_isdigit(last) || last == '.', turns = strchr("rs", *name);
    const bool angle = g_str_has_suffix(text, "deg") || g_str_has_suffix(text, "rad") ||
                       g_str_has_suffix(text, "turn");
    if (last == ')' || (plain && value == 0))
        return true;
    if (g_str_has_prefix(name, "scale"))
        return plain || last == '%';
    if (*name == 'm' || (strcmp(name, "rotate3d") == 0 && i < 3))
        return plain;
    return !plain && angle == turns;
}

/** Reads the arguments of a function of CSS: their number, -1 if they are wrong. */
static int read_arguments(const char *name, const char *text, const FlCssUnits *units, double *v)
{
    g_auto(GStrv) part = fl_css_split(text, ',');
    const bool length = g_str_has_prefix(name, "translate"), vertical = g_str_has_suffix(name, "y");
    const int n = (int)g_strv_length(part);
    for (int i = 0; i < n && n <= MOST_ARGUMENTS; i++) {
        const double whole = !length ? 1 : i == 1 || vertical ? units->height : units->width;
        if (strcmp(part[i], "none") == 0) // perspective(none)
            v[i] = 0;
        else if (!fl_css_number(part[i], units, whole, &v[i]) ||
                 !has_right_unit(name, i, part[i], v[i]))
            return -1;
    }
    return n <= MOST_ARGUMENTS ? n : -1;
}

/** Likewise those of a function of the attribute, which are plain numbers. */
static int read_numbers(const char *text, double *v)
{
    int n = 0;
    for (const char *s = fl_css_space(text); *s; s += strspn(s, FL_CSS_SPACE ","))
        if (n == MOST_ARGUMENTS || !fl_number_read(&s, &v[n++]))
            return -1;
    return n;
}

/** Reads one function and its matrix; units: NULL for those of the attribute. */
static bool read_function(const char *name, const char *arguments, const FlCssUnits *units,
                          Space *space)
{
    FlAffine plane;
    double v[MOST_ARGUMENTS];
    g_autofree char *lower = g_ascii_strdown(name, -1);
    const int n = units ? read_arguments(lower, arguments, units, v) : read_numbers(arguments, v);
    if (n >= 0 && units && map_of_space(lower, v, n, space))
        return true;
    const bool good = n >= 0 && map_of(name, v, n, &plane);
    *space = good ? space_of(&plane) : *space;
    return good;
}

/** The map of the plane in a matrix, seen from straight above. Returns: false if it has a vanishing
 * point, which is left out. */
static bool flatten(const Space *space, FlAffine *m)
{
    const double(*v)[4] = space->m, w = v[3][3] > 0 ? v[3][3] : 1;
    *m = (FlAffine){v[0][0] / w, v[1][0] / w, v[0][1] / w, v[1][1] / w, v[0][3] / w, v[1][3] / w};
    return fabs(v[3][0]) + fabs(v[3][1]) < 1e-9;
}

bool fl_affine_parse_css(const char *text, const FlCssUnits *units, FlAffine *m, bool *flat)
{
    *m = FL_AFFINE_NONE;
    Space all = space_of(m);
    const char *s = fl_css_space(text);
    if (strcmp(s, "none") == 0)
        return true;
    while (*s) {
        const char *open = s + fl_css_identifier(s), *inside = fl_css_space(open);
        const char *close = *inside == '(' ? fl_css_find(inside + 1, ")") : inside;
        g_autofree char *name = g_strndup(s, (gsize)(open - s));
        if (*inside != '(' || *close != ')' || open == s || (units && inside != open))
            return false;
        g_autofree char *arguments = g_strndup(inside + 1, (gsize)(close - inside) - 1);
        Space one;
        if (!read_function(name, arguments, units, &one))
            return false;
        all = multiply(&all, &one);
        s = close + 1 + strspn(close + 1, units ? FL_CSS_SPACE : FL_CSS_SPACE ",");
    }
    const bool in_plane = flatten(&all, m);
    if (flat)
        *flat = in_plane;
    return true;
}

bool fl_affine_parse(const char *text, FlAffine *m)
{
    return fl_affine_parse_css(text, NULL, m, NULL);
}

char *fl_affine_text(const FlAffine *m)
{
    const double v[] = {m->xx, m->yx, m->xy, m->yy, m->x0, m->y0};
    GString *text = g_string_new("matrix(");
    for (int i = 0; i < 6; i++) {
        g_autofree char *number = fl_css_number_text(v[i]);
        g_string_append_printf(text, "%s%s", i ? ", " : "", number);
    }
    return g_string_free(g_string_append_c(text, ')'), FALSE);
}

FlAffine fl_affine_of(const xmlNode *node)
{
    FlAffine m = FL_AFFINE_NONE;
    g_autoptr(xmlChar) text = fl_attribute(node, "transform");
    if (text)
        fl_affine_parse((const char *)text, &m);
    return m;
}
