#include "svg/geometry.h"

#include "base/reader.h"
#include "svg/path_data.h"
#include <math.h>
#include <string.h>

/* ---- leaves ---- */

/** Draws a basic shape. Returns: what it is. */
static FlOutlineKind draw_shape(const FlInheritance *inheritance, const xmlNode *node,
                                const FlInherited *s, FlPen *pen, bool *broken)
{
    const double w = s->width, h = s->height, mean = sqrt((w * w + h * h) / 2);
#define LENGTH(name, whole, initial) fl_length_in(inheritance, node, name, whole, initial, broken)
    if (fl_is(node, "circle")) {
        const double r = LENGTH("r", mean, 0);
        fl_pen_ellipse(pen, LENGTH("cx", w, 0), LENGTH("cy", h, 0), r, r);
        return FL_OUTLINE_CIRCLE;
    }
    if (fl_is(node, "ellipse")) {
        const double rx = LENGTH("rx", w, -1), ry = LENGTH("ry", h, -1);
        fl_pen_ellipse(pen, LENGTH("cx", w, 0), LENGTH("cy", h, 0), rx < 0 ? MAX(ry, 0) : rx,
                       ry < 0 ? MAX(rx, 0) : ry);
        return FL_OUTLINE_ELLIPSE;
    }
    if (fl_is(node, "rect")) {
        const double width = LENGTH("width", w, 0), height = LENGTH("height", h, 0);
        double rx = LENGTH("rx", w, -1), ry = LENGTH("ry", h, -1);
        rx = rx < 0 ? MAX(ry, 0) : rx, ry = ry < 0 ? rx : ry;
        rx = CLAMP(rx, 0, width / 2), ry = CLAMP(ry, 0, height / 2);
        fl_pen_rect(pen, LENGTH("x", w, 0), LENGTH("y", h, 0), width, height,
                    (double[]){rx, rx, rx, rx}, (double[]){ry, ry, ry, ry});
        return FL_OUTLINE_RECT;
    }
    if (fl_is(node, "line")) {
        fl_pen_move(pen, (FlPoint){LENGTH("x1", w, 0), LENGTH("y1", h, 0)});
        fl_pen_line(pen, (FlPoint){LENGTH("x2", w, 0), LENGTH("y2", h, 0)});
        return FL_OUTLINE_POLY;
    }
#undef LENGTH
    const bool polygon = fl_is(node, "polygon");
    if (polygon || fl_is(node, "polyline")) {
        const char *points = fl_attribute(node, "points");
        *broken |= !fl_pen_points(pen, points ? points : "", polygon);
        return FL_OUTLINE_POLY;
    }
    return FL_OUTLINE_NONE;
}

static FlOutlineKind draw_leaf(const FlInheritance *inheritance, const xmlNode *node,
                               const FlInherited *s, FlPen *pen, bool *broken)
{
    *pen = (FlPen){.subpath = pen->subpath, .cubic = pen->cubic};
    if (!fl_is(node, "path"))
        return draw_shape(inheritance, node, s, pen, broken);
    const char *d = fl_attribute(node, "d");
    if (d)
        fl_path_data_walk(d, fl_pen_step, pen);
    return FL_OUTLINE_PATH;
}

/** A hash of a name [FNV-1a]; 0 of "". Digits may be left out: exporters number frames. */
static uint64_t hash_of(const char *text, size_t n, bool digits)
{
    uint64_t hash = 0xcbf29ce484222325u;
    for (size_t k = 0; k < n; k++)
        if (digits || !g_ascii_isdigit(text[k]))
            hash = (hash ^ (uint8_t)text[k]) * 0x100000001b3u;
    return n ? hash : 0;
}

static void name_outline(FlGeometry *g, const FlLeaf *leaf)
{
    const char *slash = strrchr(leaf->tree, '/');
    g->id = hash_of(leaf->name, strlen(leaf->name), true);
    g->labels = hash_of(leaf->labels, strlen(leaf->labels), false);
    g->tree = hash_of(leaf->tree, strlen(leaf->tree), true);
    g->group = hash_of(leaf->tree, slash ? (size_t)(slash - leaf->tree) : 0, true);
}

/** Returns: true if all points are finite, in local units and in px; extreme drawings overflow. */
static bool is_finite(const FlGeometry *g, const FlCubic *cubic, size_t n)
{
    bool finite = isfinite(g->stroke);
    for (size_t i = 0; i < n; i++)
        for (int k = 0; k < 4; k++) {
            const FlPoint p = fl_affine_apply(&g->ctm, cubic[i].p[k]);
            finite = finite && isfinite(p.x) && isfinite(p.y);
        }
    return finite;
}

static FlGeometry read_leaf(FlInheritance *inheritance, const FlLeaf *leaf, const xmlNode *node,
                            FlPen *pen)
{
    FlGeometry g;
    memset(&g, 0, sizeof g); // clears the padding, since the struct is stored as bytes
    const FlInherited s = fl_inherited_by(inheritance, node);
    bool broken = s.broken;
    const guint first = pen->cubic->len;
    g.first_subpath = (int32_t)pen->subpath->len;
    g.ctm = s.ctm;
    g.kind = (uint8_t)draw_leaf(inheritance, node, &s, pen, &broken);
    g.n_subpaths = (int32_t)pen->subpath->len - g.first_subpath;
    g.clipped = s.clipped, g.evenodd = s.evenodd;
    g.filled = strcmp(s.fill, "none") != 0;
    g.stroke = strcmp(s.stroke, "none") != 0 ? s.stroke_width : 0;
    g.usable = !broken && g.kind != FL_OUTLINE_NONE && g.n_subpaths > 0 &&
               is_finite(&g, &g_array_index(pen->cubic, FlCubic, first), pen->cubic->len - first);
    g.unit = leaf->unit;
    name_outline(&g, leaf);
    return g;
}

FlOutlines *fl_outlines_of_pen(FlPen *pen)
{
    FlOutlines *outlines = g_new(FlOutlines, 1);
    *outlines =
        (FlOutlines){.n_subpaths = (int)pen->subpath->len, .n_cubics = (int)pen->cubic->len};
    outlines->subpath = (FlSubpath *)(void *)g_array_free(pen->subpath, FALSE);
    outlines->cubic = (FlCubic *)(void *)g_array_free(pen->cubic, FALSE);
    return outlines;
}

FlOutlines *fl_outlines_of_shape(const xmlNode *node, double dpi, FlPageSize viewport)
{
    const FlInheritance inheritance = {.dpi = dpi};
    const FlInherited inherited = {.width = viewport.width, .height = viewport.height};
    FlPen pen = fl_pen_new();
    bool broken = false;
    draw_leaf(&inheritance, node, &inherited, &pen, &broken);
    if (broken)
        g_array_set_size(pen.subpath, 0), g_array_set_size(pen.cubic, 0);
    return fl_outlines_of_pen(&pen);
}

FlOutlines *fl_outlines_new(FlInheritance *inheritance, const FlLeaves *list)
{
    FlPen pen = fl_pen_new();
    FlGeometry *read = g_new0(FlGeometry, list->leaf->len + 1);
    for (guint i = 0; i < list->leaf->len; i++) {
        const FlLeaf *leaf = &g_array_index(list->leaf, FlLeaf, i);
        const xmlNode *node = g_hash_table_lookup(list->ids, leaf->id);
        if (node)
            read[i] = read_leaf(inheritance, leaf, node, &pen);
    }
    FlOutlines *outlines = fl_outlines_of_pen(&pen);
    outlines->n_leaves = (int)list->leaf->len;
    outlines->leaf = read;
    return outlines;
}

void fl_outlines_scale(FlOutlines *outlines, double factor)
{
    const FlAffine scale = {factor, 0, 0, factor, 0, 0};
    for (int i = 0; i < outlines->n_leaves; i++)
        outlines->leaf[i].ctm = fl_affine_multiply(scale, outlines->leaf[i].ctm);
}

void fl_outlines_free(FlOutlines *outlines)
{
    if (!outlines)
        return;
    g_free(outlines->leaf);
    g_free(outlines->subpath);
    g_free(outlines->cubic);
    g_free(outlines);
}

uint8_t *fl_outlines_pack(const FlOutlines *o, size_t *bytes)
{
    GByteArray *out = g_byte_array_new();
    fl_put_items(out, o->leaf, o->n_leaves, sizeof *o->leaf);
    fl_put_items(out, o->subpath, o->n_subpaths, sizeof *o->subpath);
    fl_put_items(out, o->cubic, o->n_cubics, sizeof *o->cubic);
    *bytes = out->len;
    return g_byte_array_free(out, FALSE);
}

/** Returns: true if the n items from the first on lie within `all` items. */
static bool is_range(int32_t first, int32_t n, int32_t all)
{
    return first >= 0 && n >= 0 && first <= all && n <= all - first;
}

/** Returns: true if a leaf is a possible result of read_leaf(). */
static bool is_sound(const FlOutlines *o, const FlGeometry *g)
{
    bool sound = is_range(g->first_subpath, g->n_subpaths, o->n_subpaths) &&
                 g->kind <= FL_OUTLINE_POLY && g->usable <= 1;
    for (int i = 0; i < g->n_subpaths && sound; i++) {
        const FlSubpath *sub = &o->subpath[g->first_subpath + i];
        sound = sub->n > 0 && is_range(sub->first, sub->n, o->n_cubics) &&
                (!g->usable || is_finite(g, &o->cubic[sub->first], (size_t)sub->n));
    }
    return sound;
}

FlOutlines *fl_outlines_unpack(const uint8_t *data, size_t bytes)
{
    FlReader reader = fl_reader_over(data, bytes);
    g_autoptr(FlOutlines) o = g_new0(FlOutlines, 1);
    o->leaf = fl_take_items(&reader, sizeof *o->leaf, &o->n_leaves);
    o->subpath = fl_take_items(&reader, sizeof *o->subpath, &o->n_subpaths);
    o->cubic = fl_take_items(&reader, sizeof *o->cubic, &o->n_cubics);
    bool sound = fl_reader_ends(&reader);
    for (int i = 0; i < o->n_leaves && sound; i++)
        sound = is_sound(o, &o->leaf[i]);
    return sound ? g_steal_pointer(&o) : NULL;
}

FlPoint fl_cubic_at(const FlCubic *cubic, const FlAffine *ctm, double t)
{
    const double s = 1 - t, a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t, d = t * t * t;
    const FlPoint *p = cubic->p;
    return fl_affine_apply(ctm, (FlPoint){a * p[0].x + b * p[1].x + c * p[2].x + d * p[3].x,
                                          a * p[0].y + b * p[1].y + c * p[2].y + d * p[3].y});
}

static double distance(FlPoint a, FlPoint b)
{
    const double x = a.x - b.x, y = a.y - b.y;
    return sqrt(x * x + y * y);
}

int fl_cubic_steps(const FlCubic *cubic, const FlAffine *ctm, double step_px)
{
    double length = 0;
    FlPoint last = fl_affine_apply(ctm, cubic->p[0]);
    for (int k = 1; k < 4; k++) { // the control polygon is longer than the curve
        const FlPoint p = fl_affine_apply(ctm, cubic->p[k]);
        length += distance(last, p);
        last = p;
    }
    return (int)CLAMP(ceil(length / step_px), 1, 400);
}
