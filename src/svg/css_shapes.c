#include "svg/css_shapes.h"

#include "svg/normalise.h"
#include "svg/path_data.h"
#include <math.h>
#include <string.h>

#define MOST_DEPTH 64 // of groups, when boxes are measured

/* ---- boxes ----------------------------------------------------------------------------------- */

typedef struct Bounds {
    double left, top, right, bottom;
} Bounds;

static void add_point(Bounds *b, FlPoint p)
{
    b->left = MIN(b->left, p.x), b->right = MAX(b->right, p.x);
    b->top = MIN(b->top, p.y), b->bottom = MAX(b->bottom, p.y);
}

/** Finds the extrema of one coordinate of a cubic: at most two parameters inside 0 … 1. */
static int turns(double a, double b, double c, double d, double t[2])
{
    const double q = a - 2 * b + c, r = b - a, p = d - 3 * c + 3 * b - a;
    int n = 0;
    double root[2] = {-1, -1};
    if (fabs(p) < 1e-12)
        root[0] = fabs(q) > 1e-12 ? -r / (2 * q) : -1;
    else if (q * q - p * r >= 0) {
        root[0] = (-q + sqrt(q * q - p * r)) / p;
        root[1] = (-q - sqrt(q * q - p * r)) / p;
    }
    for (int k = 0; k < 2; k++)
        if (root[k] > 0 && root[k] < 1)
            t[n++] = root[k];
    return n;
}

static void add_cubic(Bounds *bounds, const FlCubic *cubic, const FlAffine *map)
{
    FlCubic c;
    double t[2];
    for (int k = 0; k < 4; k++)
        c.p[k] = fl_affine_apply(map, cubic->p[k]);
    add_point(bounds, c.p[0]);
    add_point(bounds, c.p[3]);
    for (int axis = 0; axis < 2; axis++) {
        const int n = axis ? turns(c.p[0].y, c.p[1].y, c.p[2].y, c.p[3].y, t)
                           : turns(c.p[0].x, c.p[1].x, c.p[2].x, c.p[3].x, t);
        for (int k = 0; k < n; k++)
            add_point(bounds, fl_cubic_at(&c, &FL_AFFINE_NONE, t[k]));
    }
}

FlOutlines *fl_css_outlines(const xmlNode *node, const FlCssUnits *units)
{
    return fl_outlines_of_shape(node, 96, (FlPageSize){units->width, units->height});
}

static void add_element(Bounds *bounds, const xmlNode *node, const FlCssUnits *units,
                        const FlAffine *map, int depth);

static void add_children(Bounds *bounds, const xmlNode *node, const FlCssUnits *units,
                         const FlAffine *map, int depth)
{
    const double x = fl_length_of(node, "x", units, units->width);
    const double y = fl_length_of(node, "y", units, units->height);
    const FlAffine inner =
        fl_is(node, "svg") ? fl_affine_multiply(*map, fl_affine_move(x, y)) : *map;
    FL_EACH_ELEMENT (child, node) {
        const FlAffine all = fl_affine_multiply(inner, fl_affine_of(child));
        if (!fl_is_undrawn(child))
            add_element(bounds, child, units, &all, depth + 1);
    }
}

static void add_element(Bounds *bounds, const xmlNode *node, const FlCssUnits *units,
                        const FlAffine *map, int depth)
{
    if (depth > MOST_DEPTH)
        return;
    g_autoptr(FlOutlines) outlines = fl_css_outlines(node, units);
    for (int i = 0; i < outlines->n_cubics; i++)
        add_cubic(bounds, &outlines->cubic[i], map);
    if (fl_is(node, "image") || fl_is(node, "foreignObject"))
        for (int k = 0; k < 4; k++) {
            const double x = fl_length_of(node, "x", units, units->width);
            const double y = fl_length_of(node, "y", units, units->height);
            const FlPoint corner = {
                x + (k & 1 ? fl_length_of(node, "width", units, units->width) : 0),
                y + (k & 2 ? fl_length_of(node, "height", units, units->height) : 0)};
            add_point(bounds, fl_affine_apply(map, corner));
        }
    add_children(bounds, node, units, map, depth);
}

bool fl_css_fill_box(const xmlNode *node, const FlCssUnits *units, FlCssBox *box)
{
    Bounds b = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    add_element(&b, node, units, &FL_AFFINE_NONE, 0);
    const bool found = b.right >= b.left && b.bottom >= b.top;
    *box = found ? (FlCssBox){b.left, b.top, b.right - b.left, b.bottom - b.top} : (FlCssBox){0};
    return found;
}

/* ---- lengths and places ---------------------------------------------------------------------- */

double fl_css_walk_along(const FlOutlines *outlines, double target, FlPoint *place,
                         double *direction)
{
    double length = 0;
    *place = outlines->n_cubics ? outlines->cubic[0].p[0] : (FlPoint){0, 0};
    *direction = 0;
    for (int i = 0; i < outlines->n_cubics; i++) {
        const FlCubic *cubic = &outlines->cubic[i];
        const int n = 64;
        FlPoint from = cubic->p[0];
        for (int k = 1; k <= n; k++) {
            const FlPoint to = fl_cubic_at(cubic, &FL_AFFINE_NONE, (double)k / n);
            const double step = hypot(to.x - from.x, to.y - from.y);
            if (step > 0) {
                const double t = CLAMP((target - length) / step, 0, 1);
                *place = (FlPoint){from.x + t * (to.x - from.x), from.y + t * (to.y - from.y)};
                *direction = atan2(to.y - from.y, to.x - from.x) * 180 / G_PI;
            }
            length += step;
            if (step > 0 && length >= target)
                return target;
            from = to;
        }
    }
    return length;
}

/* ---- path data ------------------------------------------------------------------------------- */

static void append_point(GString *d, const char *command, FlPoint p)
{
    g_autofree char *x = fl_css_number_text(p.x), *y = fl_css_number_text(p.y);
    g_string_append_printf(d, "%s%s %s", command, x, y);
}

char *fl_css_outline_text(const FlOutlines *outlines, const FlAffine *map)
{
    GString *d = g_string_new(NULL);
    for (int s = 0; s < outlines->n_subpaths; s++) {
        const FlSubpath *sub = &outlines->subpath[s];
        for (int k = 0; k < sub->n; k++) {
            const FlPoint *p = outlines->cubic[sub->first + k].p;
            if (k == 0)
                append_point(d, "M", fl_affine_apply(map, p[0]));
            append_point(d, "C", fl_affine_apply(map, p[1]));
            append_point(d, " ", fl_affine_apply(map, p[2]));
            append_point(d, " ", fl_affine_apply(map, p[3]));
        }
        g_string_append(d, sub->closed ? "Z" : "");
    }
    return g_string_free(d, d->len == 0);
}

FlOutlines *fl_css_outlines_of_path(const char *d)
{
    FlPen pen = fl_pen_new();
    const bool broken = fl_path_data_walk(d, fl_pen_step, &pen) != NULL;
    g_autoptr(FlOutlines) outlines = fl_outlines_of_pen(&pen);
    return broken ? NULL : g_steal_pointer(&outlines);
}

/* ---- shapes ---------------------------------------------------------------------------------- */

bool fl_css_position(const char *text, const FlCssUnits *units, FlCssBox box, FlPoint *place)
{
    static const char *const words[][2] = {
        {"left", "0%"}, {"top", "0%"}, {"center", "50%"}, {"right", "100%"}, {"bottom", "100%"}};
    g_auto(GStrv) part = fl_css_split(text, ' ');
    const char *axis[2] = {part[0], part[0] && part[1] ? part[1] : "50%"};
    double v[2];
    if (!part[0] || (part[1] && part[2] && part[3]))
        return false;
    if (strcmp(axis[0], "top") == 0 || strcmp(axis[0], "bottom") == 0 ||
        strcmp(axis[1], "left") == 0 || strcmp(axis[1], "right") == 0) {
        const char *first = axis[0];
        axis[0] = axis[1], axis[1] = first;
    }
    for (int k = 0; k < 2; k++) {
        for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
            if (strcmp(words[i][0], axis[k]) == 0)
                axis[k] = words[i][1];
        if (!fl_css_amount(axis[k], FL_CSS_SIZE | FL_CSS_SHARE, units, k ? box.height : box.width,
                           &v[k]))
            return false;
    }
    *place = (FlPoint){box.x + v[0], box.y + v[1]};
    return true;
}

/** A radius: a length, closest-side or farthest-side. */
static bool read_radius(const char *text, const FlCssUnits *units, double whole, double low,
                        double high, double *radius)
{
    if (strcmp(text, "closest-side") == 0)
        *radius = MIN(fabs(low), fabs(high));
    else if (strcmp(text, "farthest-side") == 0)
        *radius = MAX(fabs(low), fabs(high));
    else
        return fl_css_amount(text, FL_CSS_SIZE | FL_CSS_SHARE, units, whole, radius);
    return true;
}

/** circle() and ellipse(). */
static bool round_shape(const char *arguments, bool circle, const FlCssUnits *units, FlCssBox box,
                        FlPen *pen)
{
    g_auto(GStrv) word = fl_css_split(arguments, ' ');
    g_autofree char *place = NULL;
    const char *radius[2] = {"closest-side", "closest-side"};
    int n = 0;
    for (int i = 0; word[i]; i++) {
        if (strcmp(word[i], "at") == 0) {
            place = g_strjoinv(" ", word + i + 1);
            break;
        }
        if (n < 2)
            radius[n++] = word[i];
    }
    FlPoint c;
    double r[2];
    if (!fl_css_position(place ? place : "center", units, box, &c))
        return false;
    const double left = c.x - box.x, right = box.x + box.width - c.x;
    const double top = c.y - box.y, bottom = box.y + box.height - c.y;
    if (circle) {
        const bool far = strcmp(radius[0], "farthest-side") == 0;
        const double low = far ? MAX(left, right) : MIN(left, right);
        const double high = far ? MAX(top, bottom) : MIN(top, bottom);
        const double whole = hypot(box.width, box.height) / G_SQRT2;
        if (!read_radius(radius[0], units, whole, low, high, &r[0]))
            return false;
        r[1] = r[0];
    } else if (!read_radius(radius[0], units, box.width, left, right, &r[0]) ||
               !read_radius(radius[1], units, box.height, top, bottom, &r[1]))
        return false;
    fl_pen_ellipse(pen, c.x, c.y, r[0], r[1]);
    return true;
}

/** Radii that do not fit shrink alike [CSS Backgrounds 3 §4.5]. */
static void fit_radii(FlCssBox box, double across[4], double down[4])
{
    double fit = 1;
    for (int i = 0; i < 4; i++) {
        const double *r = i % 2 ? down : across;
        const double side = i % 2 ? box.height : box.width, sum = r[i] + r[(i + 1) % 4];
        fit = sum > side ? fmin(fit, side / sum) : fit;
    }
    for (int i = 0; i < 4; i++)
        across[i] *= fit, down[i] *= fit;
}

/** Reads up to four values, of which those that are missing repeat others. */
static bool read_four(char **part, const FlCssUnits *units, const double whole[4], double v[4])
{
    static const int from[5][4] = {{0}, {0, 0, 0, 0}, {0, 1, 0, 1}, {0, 1, 2, 1}, {0, 1, 2, 3}};
    const guint n = g_strv_length(part);
    if (n < 1 || n > 4)
        return false;
    for (int i = 0; i < 4; i++) {
        const char *text = part[from[n][i]];
        if (strcmp(text, "auto") == 0)
            v[i] = i == 1 || i == 2 ? whole[i] : 0;
        else if (!fl_css_amount(text, FL_CSS_SIZE | FL_CSS_SHARE, units, whole[i], &v[i]))
            return false;
    }
    return true;
}

/** Reads the radii of corners, "1px 2px / 3px"; "" is 0. */
static bool read_radii(const char *text, const FlCssUnits *units, FlCssBox box, double across[4],
                       double down[4])
{
    const double w[4] = {box.width, box.width, box.width, box.width};
    const double h[4] = {box.height, box.height, box.height, box.height};
    const char *slash = strchr(text, '/');
    g_autofree char *first = g_strndup(text, slash ? (gsize)(slash - text) : strlen(text));
    g_auto(GStrv) x = fl_css_split(first, ' ');
    g_auto(GStrv) y = fl_css_split(slash ? slash + 1 : first, ' ');
    memset(across, 0, 4 * sizeof *across), memset(down, 0, 4 * sizeof *down);
    return !*text || (read_four(x, units, w, across) && read_four(y, units, h, down));
}

/** inset(), rect() and xywh(). */
static bool rect_shape(const char *name, const char *arguments, const FlCssUnits *units,
                       FlCssBox box, FlPen *pen)
{
    const char *round = strstr(arguments, "round");
    g_autofree char *sides =
        g_strndup(arguments, round ? (gsize)(round - arguments) : strlen(arguments));
    g_auto(GStrv) part = fl_css_split(sides, ' ');
    const bool xywh = strcmp(name, "xywh") == 0, inset = strcmp(name, "inset") == 0;
    const double w = box.width, h = box.height;
    const double whole[4] = {xywh ? w : h, xywh ? h : w, xywh ? w : h, xywh ? h : w};
    double v[4], across[4], down[4];
    if ((!inset && g_strv_length(part) != 4) || !read_four(part, units, whole, v) ||
        !read_radii(round ? round + 5 : "", units, box, across, down))
        return false;
    FlCssBox at = {box.x + v[0], box.y + v[1], v[2], v[3]};
    if (!xywh)
        at = (FlCssBox){box.x + v[3], box.y + v[0], (inset ? w - v[1] : v[1]) - v[3],
                        (inset ? h - v[2] : v[2]) - v[0]};
    at.width = MAX(at.width, 0), at.height = MAX(at.height, 0);
    fit_radii(at, across, down);
    fl_pen_rect(pen, at.x, at.y, at.width, at.height, across, down);
    return true;
}

static bool take_fill_rule(char **list, bool *evenodd)
{
    *evenodd = list[0] && strcmp(list[0], "evenodd") == 0;
    return *evenodd || (list[0] && strcmp(list[0], "nonzero") == 0);
}

static bool polygon_shape(const char *arguments, const FlCssUnits *units, FlCssBox box,
                          bool *evenodd, FlPen *pen)
{
    g_auto(GStrv) pair = fl_css_split(arguments, ',');
    const int first = take_fill_rule(pair, evenodd);
    for (int i = first; pair[i]; i++) {
        FlPoint p;
        if (!fl_css_position(pair[i], units, box, &p))
            return false;
        (i == first ? fl_pen_move : fl_pen_line)(pen, p);
    }
    fl_pen_close(pen);
    return pair[first] != NULL;
}

/** path(), whose coordinates are relative to the box. */
static bool path_shape(const char *arguments, FlCssBox box, bool *evenodd, FlPen *pen)
{
    g_auto(GStrv) part = fl_css_split(arguments, ',');
    const int first = take_fill_rule(part, evenodd);
    g_autofree char *d = part[first] ? fl_css_string_or_url(part[first]) : NULL;
    const bool read = d && !fl_path_data_walk(d, fl_pen_step, pen);
    for (guint i = 0; i < 4 * pen->cubic->len; i++) {
        FlPoint *p = &g_array_index(pen->cubic, FlCubic, i / 4).p[i % 4];
        p->x += box.x, p->y += box.y;
    }
    return read;
}

FlOutlines *fl_css_basic_shape(const char *text, const FlCssUnits *units, FlCssBox box,
                               bool *evenodd)
{
    g_autofree char *name = NULL, *arguments = NULL;
    *evenodd = false;
    if (!fl_css_call(text, &name, &arguments))
        return NULL;
    FlPen pen = fl_pen_new();
    bool read = false;
    if (strcmp(name, "circle") == 0 || strcmp(name, "ellipse") == 0)
        read = round_shape(arguments, name[0] == 'c', units, box, &pen);
    else if (strcmp(name, "inset") == 0 || strcmp(name, "rect") == 0 || strcmp(name, "xywh") == 0)
        read = rect_shape(name, arguments, units, box, &pen);
    else if (strcmp(name, "polygon") == 0)
        read = polygon_shape(arguments, units, box, evenodd, &pen);
    else if (strcmp(name, "path") == 0)
        read = path_shape(arguments, box, evenodd, &pen);
    g_autoptr(FlOutlines) outlines = fl_outlines_of_pen(&pen);
    return read ? g_steal_pointer(&outlines) : NULL;
}
