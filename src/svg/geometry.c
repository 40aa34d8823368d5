#include "svg/geometry.h"

#include "svg/effects.h"
#include "svg/path_data.h"
#include "svg/transform.h"
#include <math.h>
#include <string.h>

/** The properties that the children of a node inherit. */
typedef struct Inherited {
    FlAffine ctm;
    double width, height; // of the viewport, for percentages
    bool clipped, evenodd, filled, stroked;
    double stroke; // width, local units
    bool broken;   // something could not be parsed
} Inherited;

typedef struct Reader {
    double dpi;
    double width, height;    // px of the page
    GHashTable *inherited;   // xmlNode -> Inherited
    GArray *subpath, *cubic; // FlSubpath, FlCubic
} Reader;

/* ---- ancestors of a leaf ---- */

/** A length in px; `whole` is what 100% is. */
static bool length_of(const Reader *reader, const char *text, double whole, double *px)
{
    static const struct {
        const char *name;
        double inches;
    } units[] = {{"in", 1}, {"cm", 1 / 2.54}, {"mm", 1 / 25.4}, {"pt", 1 / 72.0}, {"pc", 1 / 6.0}};
    char *end;
    const double v = g_ascii_strtod(text, &end);
    if (end == text || !isfinite(v))
        return false;
    *px = v;
    if (*end == '%')
        *px = v * whole / 100;
    else if (g_ascii_isalpha(*end) && strncmp(end, "px", 2) != 0) {
        for (size_t k = 0; k < G_N_ELEMENTS(units); k++)
            if (strncmp(end, units[k].name, 2) == 0) {
                *px = v * units[k].inches * reader->dpi;
                return true;
            }
        return false; // em and the like
    }
    return true;
}

/** An attribute's or property's length, or `initial`; *broken if it cannot be parsed. */
static double length_in(const Reader *reader, const xmlNode *node, const char *name, double whole,
                        double initial, bool *broken)
{
    g_autofree char *text = fl_property(node, name);
    double px = initial;
    if (text && strcmp(text, "auto") != 0 && !length_of(reader, text, whole, &px))
        *broken = true;
    return px;
}

/** Maps a viewBox into a viewport of width x height, as preserveAspectRatio says. */
static FlAffine fit_box(const double box[4], double width, double height, const char *ratio)
{
    double sx = width / box[2], sy = height / box[3];
    double ax = 0.5, ay = 0.5;
    if (!ratio || !strstr(ratio, "none")) {
        const bool slice = ratio && strstr(ratio, "slice");
        sx = sy = slice ? MAX(sx, sy) : MIN(sx, sy);
        ax = ratio && strstr(ratio, "xMin") ? 0 : ratio && strstr(ratio, "xMax") ? 1 : 0.5;
        ay = ratio && strstr(ratio, "YMin") ? 0 : ratio && strstr(ratio, "YMax") ? 1 : 0.5;
    }
    return (FlAffine){sx,
                      0,
                      0,
                      sy,
                      ax * (width - sx * box[2]) - sx * box[0],
                      ay * (height - sy * box[3]) - sy * box[1]};
}

static bool view_box(const xmlNode *node, double box[4])
{
    g_autoptr(xmlChar) text = fl_attribute(node, "viewBox");
    const char *s = (const char *)text;
    for (int k = 0; k < 4; k++) {
        char *end = NULL;
        if (!s)
            return false;
        s += strspn(s, " \t\r\n\f,");
        box[k] = g_ascii_strtod(s, &end);
        if (end == s)
            return false;
        s = end;
    }
    return box[2] > 0 && box[3] > 0;
}

/** An <svg>: its place, its viewport and its viewBox. */
static void enter_viewport(const Reader *reader, const xmlNode *node, Inherited *s)
{
    const bool outermost = !node->parent || node->parent->type != XML_ELEMENT_NODE;
    const double w = s->width, h = s->height;
    bool *broken = &s->broken;
    double box[4] = {0, 0, 0, 0};
    const bool boxed = view_box(node, box);
    g_autoptr(xmlChar) ratio = fl_attribute(node, "preserveAspectRatio");
    if (outermost) { // the page is its viewport; without a viewBox its size is one
        if (!boxed) {
            box[2] = length_in(reader, node, "width", 0, 0, broken);
            box[3] = length_in(reader, node, "height", 0, 0, broken);
        }
    } else {
        const double x = length_in(reader, node, "x", w, 0, broken);
        const double y = length_in(reader, node, "y", h, 0, broken);
        const FlAffine place = {1, 0, 0, 1, x, y};
        s->width = length_in(reader, node, "width", w, w, broken);
        s->height = length_in(reader, node, "height", h, h, broken);
        s->ctm = fl_affine_multiply(&s->ctm, &place);
        g_autofree char *overflow = fl_property(node, "overflow");
        const bool shown =
            overflow && (g_str_equal(overflow, "visible") || g_str_equal(overflow, "auto"));
        s->clipped |= !shown;
    }
    if (box[2] > 0 && box[3] > 0) {
        const FlAffine fit = fit_box(box, s->width, s->height, (const char *)ratio);
        s->ctm = fl_affine_multiply(&s->ctm, &fit);
        s->width = box[2], s->height = box[3];
    }
}

static void enter_properties(const Reader *reader, const xmlNode *node, Inherited *s)
{
    s->clipped |=
        fl_is_set(node, "clip-path") || fl_is_set(node, "mask") || fl_is_set(node, "filter");
    g_autofree char *rule = fl_property(node, "fill-rule"), *fill = fl_property(node, "fill");
    g_autofree char *stroke = fl_property(node, "stroke");
    if (rule)
        s->evenodd = strcmp(rule, "evenodd") == 0;
    if (fill)
        s->filled = strcmp(fill, "none") != 0;
    if (stroke)
        s->stroked = strcmp(stroke, "none") != 0;
    bool ignored = false;
    const double mean = sqrt((s->width * s->width + s->height * s->height) / 2);
    s->stroke = length_in(reader, node, "stroke-width", mean, s->stroke, &ignored);
}

static Inherited inherited_by(Reader *reader, const xmlNode *node)
{
    const Inherited page = {.ctm = FL_AFFINE_NONE,
                            .width = reader->width,
                            .height = reader->height,
                            .filled = true,
                            .stroke = 1};
    if (!node || node->type != XML_ELEMENT_NODE)
        return page;
    const Inherited *known = g_hash_table_lookup(reader->inherited, node);
    if (known)
        return *known;
    Inherited s = inherited_by(reader, node->parent);
    const FlAffine m = fl_affine_of(node);
    s.ctm = fl_affine_multiply(&s.ctm, &m);
    if (fl_is(node, "svg"))
        enter_viewport(reader, node, &s);
    enter_properties(reader, node, &s);
    if (node->children) {
        Inherited *copy = g_new(Inherited, 1);
        *copy = s;
        g_hash_table_insert(reader->inherited, (gpointer)node, copy);
    }
    return s;
}

/* ---- leaves ---- */

/** Draws a basic shape. Returns: what it is. */
static FlOutlineKind draw_shape(const Reader *reader, const xmlNode *node, const Inherited *s,
                                FlPen *pen, bool *broken)
{
    const double w = s->width, h = s->height, mean = sqrt((w * w + h * h) / 2);
#define LENGTH(name, whole, initial) length_in(reader, node, name, whole, initial, broken)
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
        fl_pen_rect(pen, LENGTH("x", w, 0), LENGTH("y", h, 0), width, height,
                    CLAMP(rx, 0, width / 2), CLAMP(ry, 0, height / 2));
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
        g_autoptr(xmlChar) points = fl_attribute(node, "points");
        fl_pen_points(pen, points ? (const char *)points : "", polygon);
        return FL_OUTLINE_POLY;
    }
    return FL_OUTLINE_NONE;
}

static FlOutlineKind draw_leaf(const Reader *reader, const xmlNode *node, const Inherited *s,
                               FlPen *pen, bool *broken)
{
    if (!fl_is(node, "path"))
        return draw_shape(reader, node, s, pen, broken);
    g_autoptr(xmlChar) d = fl_attribute(node, "d");
    if (d)
        fl_path_data_walk((const char *)d, fl_pen_step, pen);
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

static FlGeometry read_leaf(Reader *reader, const FlLeaf *leaf, const xmlNode *node)
{
    FlGeometry g;
    memset(&g, 0, sizeof g); // clears the padding, since the struct is stored as bytes
    FlPen pen = {.subpath = reader->subpath, .cubic = reader->cubic};
    const Inherited s = inherited_by(reader, node);
    bool broken = s.broken;
    const guint first = reader->cubic->len;
    g.first_subpath = (int32_t)reader->subpath->len;
    g.ctm = s.ctm;
    g.kind = (uint8_t)draw_leaf(reader, node, &s, &pen, &broken);
    g.n_subpaths = (int32_t)reader->subpath->len - g.first_subpath;
    g.clipped = s.clipped, g.evenodd = s.evenodd, g.filled = s.filled;
    g.stroke = s.stroked ? s.stroke : 0;
    g.usable =
        !broken && g.kind != FL_OUTLINE_NONE && g.n_subpaths > 0 &&
        is_finite(&g, &g_array_index(reader->cubic, FlCubic, first), reader->cubic->len - first);
    g.unit = leaf->unit;
    name_outline(&g, leaf);
    return g;
}

static FlOutlines *outlines_of(int n_leaves, int n_subpaths, int n_cubics)
{
    FlOutlines *outlines = g_new0(FlOutlines, 1);
    *outlines = (FlOutlines){n_leaves,
                             n_subpaths,
                             n_cubics,
                             g_new0(FlGeometry, n_leaves + 1),
                             g_new0(FlSubpath, n_subpaths + 1),
                             g_new0(FlCubic, n_cubics + 1)};
    return outlines;
}

static void take_curves(FlOutlines *outlines, const GArray *subpath, const GArray *cubic)
{
    if (subpath->len > 0)
        memcpy(outlines->subpath, subpath->data, subpath->len * sizeof(FlSubpath));
    if (cubic->len > 0)
        memcpy(outlines->cubic, cubic->data, cubic->len * sizeof(FlCubic));
}

FlOutlines *fl_outlines_of_shape(const xmlNode *node, double dpi, FlPageSize viewport)
{
    g_autoptr(GArray) subpath = g_array_new(FALSE, TRUE, sizeof(FlSubpath));
    g_autoptr(GArray) cubic = g_array_new(FALSE, TRUE, sizeof(FlCubic));
    const Reader reader = {.dpi = dpi};
    const Inherited inherited = {.width = viewport.width, .height = viewport.height};
    FlPen pen = {.subpath = subpath, .cubic = cubic};
    bool broken = false;
    draw_leaf(&reader, node, &inherited, &pen, &broken);
    FlOutlines *outlines =
        outlines_of(0, broken ? 0 : (int)subpath->len, broken ? 0 : (int)cubic->len);
    if (!broken)
        take_curves(outlines, subpath, cubic);
    return outlines;
}

FlOutlines *fl_outlines_new(xmlDoc *doc, const FlLeaves *list, double dpi, FlPageSize page)
{
    const GArray *leaves = list->leaf;
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    g_autoptr(GHashTable) inherited = g_hash_table_new_full(NULL, NULL, NULL, g_free);
    g_autoptr(GArray) subpath = g_array_new(FALSE, TRUE, sizeof(FlSubpath));
    g_autoptr(GArray) cubic = g_array_new(FALSE, TRUE, sizeof(FlCubic));
    Reader reader = {dpi, page.width, page.height, inherited, subpath, cubic};
    g_autofree FlGeometry *read = g_new0(FlGeometry, leaves->len + 1);
    for (guint i = 0; i < leaves->len; i++) {
        const FlLeaf *leaf = &g_array_index(leaves, FlLeaf, i);
        const xmlNode *node = g_hash_table_lookup(ids, leaf->id);
        if (node)
            read[i] = read_leaf(&reader, leaf, node);
    }
    FlOutlines *outlines = outlines_of((int)leaves->len, (int)subpath->len, (int)cubic->len);
    memcpy(outlines->leaf, read, leaves->len * sizeof *read);
    take_curves(outlines, subpath, cubic);
    return outlines;
}

void fl_outlines_scale(FlOutlines *outlines, double factor)
{
    const FlAffine scale = {factor, 0, 0, factor, 0, 0};
    for (int i = 0; i < outlines->n_leaves; i++)
        outlines->leaf[i].ctm = fl_affine_multiply(&scale, &outlines->leaf[i].ctm);
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
    const int32_t n[4] = {o->n_leaves, o->n_subpaths, o->n_cubics, 0};
    const size_t leaves = n[0] * sizeof *o->leaf, subpaths = n[1] * sizeof *o->subpath;
    const size_t cubics = n[2] * sizeof *o->cubic;
    *bytes = sizeof n + leaves + subpaths + cubics;
    uint8_t *data = g_malloc(*bytes), *to = data;
    memcpy(to, n, sizeof n);
    memcpy(to += sizeof n, o->leaf, leaves);
    memcpy(to += leaves, o->subpath, subpaths);
    memcpy(to + subpaths, o->cubic, cubics);
    return data;
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
    int32_t n[4];
    if (bytes < sizeof n)
        return NULL;
    memcpy(n, data, sizeof n);
    if (n[0] < 0 || n[1] < 0 || n[2] < 0)
        return NULL;
    const size_t leaves = (size_t)n[0] * sizeof(FlGeometry);
    const size_t subpaths = (size_t)n[1] * sizeof(FlSubpath);
    const size_t cubics = (size_t)n[2] * sizeof(FlCubic);
    if (bytes != sizeof n + leaves + subpaths + cubics)
        return NULL;
    g_autoptr(FlOutlines) o = outlines_of(n[0], n[1], n[2]);
    memcpy(o->leaf, data += sizeof n, leaves);
    memcpy(o->subpath, data += leaves, subpaths);
    memcpy(o->cubic, data + subpaths, cubics);
    for (int i = 0; i < o->n_leaves; i++)
        if (!is_sound(o, &o->leaf[i]))
            return NULL;
    return g_steal_pointer(&o);
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
