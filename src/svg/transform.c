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

/** Functions whose arguments are cells of the matrix, whose tangents are those of skews: the row
 * and the column of each. */
static const struct {
    const char *name;
    int least, most;
    uint8_t cell[6];
} by_cells[] = {
    {"matrix", 6, 6, {0x00, 0x10, 0x01, 0x11, 0x03, 0x13}},
    {"translate", 1, 2, {0x03, 0x13}},
    {"translatex", 1, 1, {0x03}},
    {"translatey", 1, 1, {0x13}},
    {"translatez", 1, 1, {0x23}},
    {"translate3d", 3, 3, {0x03, 0x13, 0x23}},
    {"scale", 1, 2, {0x00, 0x11}},
    {"scalex", 1, 1, {0x00}},
    {"scaley", 1, 1, {0x11}},
    {"scalez", 1, 1, {0x22}},
    {"scale3d", 3, 3, {0x00, 0x11, 0x22}},
    {"skew", 1, 2, {0x01, 0x10}},
    {"skewx", 1, 1, {0x01}},
    {"skewy", 1, 1, {0x10}},
};

/** The matrix of a function; false if it is unknown or has a wrong number of arguments. */
static bool map_of(const char *name, const double *v, int n, Space *space)
{
    const bool skews = g_str_has_prefix(name, "skew");
    *space = space_of(&FL_AFFINE_NONE);
    for (size_t k = 0; k < G_N_ELEMENTS(by_cells); k++) {
        if (strcmp(name, by_cells[k].name) != 0)
            continue;
        for (int i = 0; i < MIN(n, by_cells[k].most); i++)
            space->m[by_cells[k].cell[i] >> 4][by_cells[k].cell[i] & 15] =
                skews ? tangent(v[i]) : v[i];
        if (n == 1 && strcmp(name, "scale") == 0)
            space->m[1][1] = v[0];
        return n >= by_cells[k].least && n <= by_cells[k].most;
    }
#define IS(word, count) (strcmp(name, word) == 0 && n == (count))
    if (IS("perspective", 1))
        space->m[3][2] = v[0] > 0 ? -1 / fmax(v[0], 1) : 0;
    else if (IS("rotate", 1) || IS("rotatez", 1) || IS("rotatex", 1) || IS("rotatey", 1))
        return rotation_in_space(
            (double[]){name[6] == 'x', name[6] == 'y', name[6] != 'x' && name[6] != 'y'}, v[0],
            space);
    else if (IS("rotate", 3)) { // about a point
        FlAffine turn = fl_affine_multiply(fl_affine_move(v[1], v[2]), fl_affine_rotation(v[0]));
        turn = fl_affine_multiply(turn, fl_affine_move(-v[1], -v[2]));
        *space = space_of(&turn);
    } else if (IS("rotate3d", 4))
        return rotation_in_space(v, v[3], space);
    else if (IS("matrix3d", 16))
        for (int i = 0; i < 16; i++)
            space->m[i % 4][i / 4] = v[i];
    else
        return false;
    return true;
#undef IS
}

/** The kinds of the i-th argument of a function of CSS. */
static int kinds_of(const char *name, int i)
{
    return g_str_has_prefix(name, "scale")                            ? FL_CSS_PLAIN | FL_CSS_SHARE
           : *name == 'm' || (strcmp(name, "rotate3d") == 0 && i < 3) ? FL_CSS_PLAIN
           : strchr("rs", *name)                                      ? FL_CSS_ANGLE
                                                                      : FL_CSS_SIZE | FL_CSS_SHARE;
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
        else if (!fl_css_amount(part[i], kinds_of(name, i), units, whole, &v[i]))
            return -1;
    }
    return n <= MOST_ARGUMENTS && !g_str_has_suffix(text, ",") ? n : -1;
}

/** Reads one function and its matrix; units: NULL for those of the attribute. */
static bool read_function(const char *name, const char *arguments, const FlCssUnits *units,
                          Space *space)
{
    double v[MOST_ARGUMENTS];
    g_autofree char *lower = g_ascii_strdown(name, -1);
    const int n = units ? read_arguments(lower, arguments, units, v)
                        : fl_numbers_read(arguments, v, MOST_ARGUMENTS);
    return n >= 0 &&
           (units || fl_css_has_word("matrix translate scale rotate skewX skewY", name)) &&
           map_of(lower, v, n, space);
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
        s = fl_css_space(close + 1);
        if (!units && *s == ',' && !*(s = fl_css_space(s + 1)))
            return false;
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

void fl_set_affine(xmlNode *node, const char *name, FlAffine m)
{
    g_autofree char *text = fl_affine_text(&m);
    fl_set_attribute(node, name, text);
}

FlAffine fl_affine_of(const xmlNode *node)
{
    FlAffine m = FL_AFFINE_NONE;
    const char *text = fl_attribute(node, "transform");
    if (text)
        fl_affine_parse(text, &m);
    return m;
}
