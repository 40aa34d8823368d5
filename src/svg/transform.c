#include "svg/transform.h"

#include "svg/css_scan.h"
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
        double v;
        if (call->n == MOST_ARGUMENTS || !fl_number_read(&s, &v))
            return NULL;
        const char *end = s;
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

/** Reads the arguments of one function and its matrix. */
static bool map_of_css(const char *name, const char *arguments, const FlCssUnits *units,
                       Space *space)
{
    FlAffine plane;
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
    if (map_of_space(lower, v, n, space))
        return true;
    Call call = {.name = name, .length = strlen(name), .n = n};
    memcpy(call.v, v, sizeof v);
    const bool good = map_of(&call, &plane);
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
        const char *open = s + fl_css_identifier(s);
        const char *close = *open == '(' ? fl_css_find(open + 1, ")") : open;
        g_autofree char *name = g_strndup(s, (gsize)(open - s));
        if (*open != '(' || *close != ')')
            return false;
        g_autofree char *arguments = g_strndup(open + 1, (gsize)(close - open) - 1);
        Space one;
        if (!map_of_css(name, arguments, units, &one))
            return false;
        all = multiply(&all, &one);
        s = fl_css_space(close + 1);
    }
    const bool in_plane = flatten(&all, m);
    if (flat)
        *flat = in_plane;
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
