#include "svg/cascade.h"
#include "svg/css_colour.h"
#include "svg/css_scan.h"
#include "svg/document.h"
#include "svg/inherited.h"
#include "svg/normalise.h"
#include "svg/svg_data.h"
#include "svg/svg_frame.h"
#include <math.h>
#include <string.h>

#define MOST_ELEMENTS 10000 // that a leaf shows; <use> in <use> would be endless
#define MOST_NESTED 1000
#define MOST_REFERENCES 16 // from gradient to gradient
#define LEAST_OPACITY (1 / 510.0)

/** The effects of groups on their content. */
typedef struct Around {
    double opacity;
    FlBlendMode blend_mode; // of the outermost group that has one
    bool filtered;
    int depth; // elements of the leaf around it
} Around;

/** A fill, a stroke or a picture. */
typedef struct Op {
    bool stroke;
    FlBlendMode blend_mode;
    double width; // of a stroke, px of the page; else 0
    FlSvgPaint paint;
} Op;

typedef struct Reader {
    FlSvg *svg;
    GArray *ops;
    int left; // elements that may be looked at
} Reader;

static void op_clear(void *data)
{
    fl_svg_paint_clear(&((Op *)data)->paint);
}

static uint8_t to_byte(double v)
{
    return (uint8_t)CLAMP(lround(v * 255), 0, 255);
}

/* ---- paints ---- */

/** A paint before the opacity of groups; key: owned. */
typedef struct Source {
    FlPaintKind kind;
    double rgba[4], peak;
    char *key;
} Source;

/** The sum over a gradient up to a stop. */
typedef struct Ramp {
    GString *key;
    int n_stops;
    double offset, rgba[4]; // of the last stop
    double sum[4], peak;
} Ramp;

/** Adds the stretch up to offset, whose colours change evenly from the last stop's to rgba. */
static void add_stretch(Ramp *ramp, double offset, const double rgba[4])
{
    const double length = offset - ramp->offset;
    for (int c = 0; c < 4; c++)
        ramp->sum[c] += length * (ramp->rgba[c] + rgba[c]) / 2;
    memcpy(ramp->rgba, rgba, sizeof ramp->rgba);
    ramp->offset = offset;
}

/** Another file from which the drawing takes gradients; all NULL if it cannot be read. */
typedef struct Other {
    xmlDoc *doc;
    GHashTable *ids;
} Other;

static void other_free(void *data)
{
    Other *other = data;
    g_clear_pointer(&other->ids, g_hash_table_unref);
    g_clear_pointer(&other->doc, xmlFreeDoc);
    g_free(other);
}

static Other *read_other(FlSvg *svg, const char *file)
{
    Other *other = g_new0(Other, 1);
    other->doc = fl_document_read(file, 1, NULL, NULL);
    if (other->doc && fl_cascade(other->doc, file, 1, NAN, NULL, svg->files, NULL, NULL))
        other->ids = fl_document_ids(other->doc);
    return other;
}

/** The elements by id of the file that a reference names; NULL if it may not or cannot be read. */
static GHashTable *elements_of_other(FlSvg *svg, const char *target)
{
    bool is_there = false;
    g_autofree char *file = fl_reference_file(svg->path, target, &is_there);
    if (!is_there || !fl_reference_is_inside(svg->path, file))
        return NULL;
    Other *other = g_hash_table_lookup(svg->others, file);
    if (!other) {
        other = read_other(svg, file);
        g_hash_table_insert(svg->others, g_steal_pointer(&file), other);
    }
    return other->ids;
}

/** The element of "#id", or of "file.svg#id", as Flash writes gradients; NULL without one. */
static const xmlNode *element_of(const Reader *r, const char *target)
{
    const char *id = target ? strchr(target, '#') : NULL;
    if (!id)
        return NULL;
    GHashTable *ids = id == target ? r->svg->leaves->ids : elements_of_other(r->svg, target);
    return ids ? g_hash_table_lookup(ids, id + 1) : NULL;
}

/** The element that a href refers to; NULL without one. */
static const xmlNode *referred_by(const Reader *r, const xmlNode *node)
{
    g_autofree char *href = fl_href(node);
    return element_of(r, href);
}

/** The element of the url() that *text begins with, which is skipped; NULL without one. */
static const xmlNode *take_reference(const Reader *r, const char **text)
{
    g_autofree char *target = fl_css_take_url(text);
    return element_of(r, target);
}

/** Rounds a value of which names are made: exact halves between two levels are common. */
static double six_digits(double v)
{
    return round(v * 1e6) / 1e6;
}

/** Reads a colour. Returns: false if it is none. */
static bool read_colour(const char *text, const FlInherited *s, double opacity, double rgba[4])
{
    uint8_t level[4];
    if (!fl_css_rgba(g_ascii_strcasecmp(text, "currentColor") == 0 ? s->color : text, level))
        return false;
    for (int c = 0; c < 3; c++)
        rgba[c] = six_digits((double)((float)level[c] / 255)); // its floats
    rgba[3] = round(level[3] * opacity) / 255;                 // as librsvg rounds
    return true;
}

static void add_stop(Reader *r, const xmlNode *stop, double opacity, Ramp *ramp)
{
    const FlInherited s = fl_inherited_by(&r->svg->inheritance, stop);
    g_autofree char *colour = fl_property(stop, "stop-color");
    double rgba[4] = {0, 0, 0, 1};
    const double own = fl_share_in(stop, "stop-opacity", 1);
    if (!colour || !read_colour(colour, &s, own, rgba))
        read_colour("black", &s, own, rgba);
    rgba[3] = six_digits(rgba[3] * opacity);
    const double offset = MAX(fl_share_in(stop, "offset", 0), ramp->offset);
    if (ramp->n_stops++ == 0)
        memcpy(ramp->rgba, rgba, sizeof ramp->rgba);
    ramp->peak = MAX(ramp->peak, rgba[3]);
    add_stretch(ramp, offset, rgba);
    g_string_append_printf(ramp->key, " %d:%02x%02x%02x%02x", (int)lround(offset * 100),
                           to_byte(rgba[0]), to_byte(rgba[1]), to_byte(rgba[2]), to_byte(rgba[3]));
}

static bool has_child(const xmlNode *node, const char *name)
{
    bool found = false;
    for (const xmlNode *child = node->children; child && !found; child = child->next)
        found = name ? fl_is(child, name) : child->type == XML_ELEMENT_NODE;
    return found;
}

/** The element that a gradient or pattern takes its content from; NULL without one. */
static const xmlNode *with_content(const Reader *r, const xmlNode *server, const char *name)
{
    int references = 0;
    while (server && !has_child(server, name) && references++ < MOST_REFERENCES)
        server = referred_by(r, server);
    return server && has_child(server, name) ? server : NULL;
}

static void make_flat(Source *source)
{
    const double *v = source->rgba;
    g_free(source->key);
    source->kind = FL_PAINT_FLAT;
    source->peak = v[3];
    source->key = g_strdup_printf("#%02x%02x%02x", to_byte(v[0]), to_byte(v[1]), to_byte(v[2]));
}

static bool read_gradient(Reader *r, const xmlNode *gradient, double opacity, Source *source)
{
    const xmlNode *stops = with_content(r, gradient, "stop");
    if (!stops)
        return false;
    Ramp ramp = {.key = g_string_new(fl_is(gradient, "linearGradient") ? "linear" : "radial")};
    for (const xmlNode *stop = stops->children; stop; stop = stop->next)
        if (fl_is(stop, "stop"))
            add_stop(r, stop, opacity, &ramp);
    add_stretch(&ramp, 1, ramp.rgba);
    *source = (Source){.kind = FL_PAINT_GRADIENT, .peak = ramp.peak};
    source->key = g_string_free(ramp.key, FALSE);
    memcpy(source->rgba, ramp.sum, sizeof source->rgba);
    if (ramp.n_stops == 1)
        make_flat(source);
    return true;
}

static bool read_server(Reader *r, const xmlNode *server, double opacity, Source *source)
{
    if (server && fl_is_one_of(server, "linearGradient radialGradient"))
        return read_gradient(r, server, opacity, source);
    if (!server || !fl_is(server, "pattern") || !with_content(r, server, NULL))
        return false;
    *source = (Source){FL_PAINT_IMAGE, {0, 0, 0, 1}, 1, g_strdup("image")};
    return true;
}

/** Reads a paint. Returns: false if it is none. */
static bool read_paint(Reader *r, const char *text, const FlInherited *s, double opacity,
                       Source *source)
{
    if (g_str_has_prefix(text, "url(")) {
        const xmlNode *server = take_reference(r, &text);
        text = fl_css_space(text);
        return read_server(r, server, opacity, source) ||
               (*text && read_paint(r, text, s, opacity, source));
    }
    *source = (Source){0};
    if (!read_colour(text, s, opacity, source->rgba))
        return false;
    make_flat(source);
    return true;
}

/* ---- what is drawn ---- */

static void add_op(Reader *r, const Source *source, const Around *around, bool stroke, double width)
{
    const double *v = source->rgba;
    const Op op = {stroke,
                   around->blend_mode,
                   width,
                   {source->kind,
                    {to_byte(v[0]), to_byte(v[1]), to_byte(v[2])},
                    to_byte(v[3] * around->opacity),
                    to_byte(source->peak * around->opacity),
                    source->key}};
    if (v[3] * around->opacity >= LEAST_OPACITY)
        g_array_append_val(r->ops, op);
    else
        g_free(source->key);
}

static void add_image(Reader *r, const Around *around)
{
    const Source image = {FL_PAINT_IMAGE, {0, 0, 0, 1}, 1, g_strdup("image")};
    add_op(r, &image, around, false, 0);
}

static void add_fill(Reader *r, const FlInherited *s, const Around *around)
{
    Source source;
    if (read_paint(r, s->fill, s, s->fill_opacity, &source))
        add_op(r, &source, around, false, 0);
}

static void add_stroke(Reader *r, const FlInherited *s, const Around *around)
{
    Source source;
    if (s->stroke_width > 0 && read_paint(r, s->stroke, s, s->stroke_opacity, &source))
        add_op(r, &source, around, true,
               s->stroke_width * sqrt(fabs(s->ctm.xx * s->ctm.yy - s->ctm.xy * s->ctm.yx)));
}

static void add_shape(Reader *r, const FlInherited *s, const Around *around)
{
    if (s->stroke_first)
        add_stroke(r, s, around);
    add_fill(r, s, around);
    if (!s->stroke_first)
        add_stroke(r, s, around);
}

static FlBlendMode blend_mode_of(const xmlNode *node)
{
    static const char *const names[FL_N_BLEND_MODES] = {
        "normal",      "multiply",   "screen",     "overlay",    "darken",     "lighten",
        "color-dodge", "color-burn", "hard-light", "soft-light", "difference", "exclusion",
        "hue",         "saturation", "color",      "luminosity"};
    g_autofree char *name = fl_property(node, "mix-blend-mode");
    int mode = FL_N_BLEND_MODES - 1;
    while (mode > 0 && !(name && strcmp(name, names[mode]) == 0))
        mode--;
    return (FlBlendMode)mode;
}

/** The effects on what is in a group within others. */
static Around within(const Around *around, const xmlNode *group)
{
    Around inner = *around;
    inner.opacity *= fl_share_in(group, "opacity", 1);
    inner.filtered |= fl_is_set(group, "filter");
    if (inner.blend_mode == FL_BLEND_MODE_OVER)
        inner.blend_mode = blend_mode_of(group);
    return inner;
}

/** The effects of all groups around an element. */
static Around around_of(const xmlNode *node)
{
    if (fl_is_root(node))
        return (Around){.opacity = 1};
    const Around outer = around_of(node->parent);
    return outer.filtered ? outer : within(&outer, node->parent);
}

static void add_element(Reader *r, const xmlNode *node, const FlInherited *s, const Around *outer);

static void add_children(Reader *r, const xmlNode *node, const FlInherited *s, const Around *around)
{
    FL_EACH_ELEMENT (child, node) {
        if (fl_is_undrawn(child))
            continue;
        const FlInherited own = fl_inherited_from(&r->svg->inheritance, child, s);
        add_element(r, child, &own, around);
    }
}

/** Returns: true if a box or circle has no size: it is not drawn. */
static bool is_empty(const Reader *r, const xmlNode *node, const FlInherited *s)
{
    bool broken = false;
#define LENGTH(name) fl_length_in(&r->svg->inheritance, node, name, s->width, 0, &broken)
    return fl_is(node, "rect")     ? !(LENGTH("width") > 0 && LENGTH("height") > 0)
           : fl_is(node, "circle") ? !(LENGTH("r") > 0)
                                   : !(LENGTH("rx") > 0 || LENGTH("ry") > 0);
#undef LENGTH
}

/** Returns: true if an element of a text has letters of its own. */
static bool has_letters(const xmlNode *node)
{
    bool found = false;
    for (const xmlNode *child = node->children; child && !found && fl_is_one_of(node, "text tspan");
         child = child->next)
        found = child->type != XML_ELEMENT_NODE && child->content &&
                child->content[strspn((const char *)child->content, " \t\r\n")];
    return found;
}

static void add_markers(Reader *r, const FlInherited *s, const Around *around)
{
    for (int k = 0; k < FL_MARKERS; k++) {
        const char *text = s->marker[k];
        const xmlNode *marker = take_reference(r, &text);
        if (!marker || !fl_is(marker, "marker"))
            continue;
        const FlInherited own = fl_inherited_by(&r->svg->inheritance, marker);
        const Around inner = within(around, marker);
        add_children(r, marker, &own, &inner);
    }
}

static void add_used(Reader *r, const xmlNode *use, const FlInherited *s, const Around *around)
{
    const xmlNode *shown = referred_by(r, use);
    if (!shown)
        return;
    const FlInherited own = fl_inherited_from(&r->svg->inheritance, shown, s);
    if (fl_is(shown, "symbol")) // librsvg ignores its own effects
        add_children(r, shown, &own, around);
    else
        add_element(r, shown, &own, around);
}

/** Adds what an element draws without its children. */
static void add_own(Reader *r, const xmlNode *node, const FlInherited *s, const Around *around)
{
    const bool line = fl_is_one_of(node, "path line polyline polygon"),
               area = fl_is_one_of(node, "rect circle ellipse");
    const bool drawn = line || (area && !is_empty(r, node, s)) || has_letters(node);
    if (drawn && !s->hidden)
        add_shape(r, s, around);
    if (line && !s->hidden)
        add_markers(r, s, around);
}

/** Adds all that an element draws, bottom up. */
static void add_element(Reader *r, const xmlNode *node, const FlInherited *s, const Around *outer)
{
    Around around = within(outer, node);
    around.depth++;
    g_autofree char *display = fl_property(node, "display");
    if (r->left-- <= 0 || around.depth > MOST_NESTED || (display && strcmp(display, "none") == 0))
        return;
    if (around.filtered || fl_is(node, "image")) {
        add_image(r, &around);
    } else if (fl_is(node, "use")) {
        add_used(r, node, s, &around);
    } else if (fl_is_container(node) || fl_is(node, "switch")) { // left in markers alone
        add_children(r, node, s, &around);
    } else {
        add_own(r, node, s, &around);
        if (fl_is_one_of(node, "text tspan"))
            add_children(r, node, s, &around);
    }
}

/* ---- a leaf ---- */

static bool same_paint(const FlSvgPaint *a, const FlSvgPaint *b)
{
    return a->kind == b->kind && a->alpha == b->alpha && strcmp(a->key, b->key) == 0;
}

/** The paint of all ops that fit, MIXED if they differ. which: 0 fills, 1 strokes, 2 both. */
static FlPainted join(const GArray *ops, int which, FlPart part)
{
    FlPainted painted = {.part = part, .stroke = true};
    bool first = true;
    FL_EACH (const Op, op, ops) {
        if (which != 2 && op->stroke != (which == 1))
            continue;
        painted.stroke = painted.stroke && op->stroke;
        painted.blend_mode =
            first || op->blend_mode == painted.blend_mode ? op->blend_mode : FL_BLEND_MODE_OVER;
        painted.width = MAX(painted.width, (float)op->width);
        FlSvgPaint paint = op->paint;
        paint.key = g_strdup(op->paint.key);
        if (first) {
            painted.paint = paint;
        } else {
            if (!same_paint(&paint, &painted.paint)) {
                painted.paint.kind = FL_PAINT_MIXED;
                painted.paint.alpha = MAX(painted.paint.alpha, paint.alpha);
                painted.paint.peak = MAX(painted.paint.peak, paint.peak);
                g_free(painted.paint.key);
                painted.paint.key = g_strdup("mixed");
            }
            fl_svg_paint_clear(&paint);
        }
        first = false;
    }
    return painted;
}

static int take_apart(const GArray *ops, bool whole, FlPainted parts[FL_MOST_PARTS])
{
    guint strokes = 0;
    for (guint i = 0; i < ops->len; i++)
        strokes += g_array_index(ops, Op, i).stroke;
    if (ops->len == 0)
        return 0;
    parts[0] = join(ops, 2, FL_PART_WHOLE);
    const FlSvgPaint *paint = &parts[0].paint;
    const bool uniform = paint->kind == FL_PAINT_FLAT && (paint->alpha == 255 || ops->len == 1);
    if (whole || uniform || parts[0].blend_mode != FL_BLEND_MODE_OVER || strokes == 0 ||
        strokes == ops->len)
        return 1;
    fl_svg_paint_clear(&parts[0].paint);
    const int first = g_array_index(ops, Op, 0).stroke;
    parts[0] = join(ops, first, first ? FL_PART_STROKE : FL_PART_FILL);
    parts[1] = join(ops, !first, first ? FL_PART_FILL : FL_PART_STROKE);
    return 2;
}

int fl_svg_leaf_paints(FlSvg *svg, const FlLeaf *leaf, FlPageSize page,
                       FlPainted parts[FL_MOST_PARTS])
{
    if (leaf->all) {
        parts[0] = (FlPainted){.part = FL_PART_WHOLE,
                               .paint = {FL_PAINT_MIXED, {0}, 255, 255, g_strdup("mixed")}};
        return 1;
    }
    FlInheritance *inheritance = fl_svg_inheritance(svg, page);
    if (!svg->others)
        svg->others = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, other_free);
    const xmlNode *node = g_hash_table_lookup(svg->leaves->ids, leaf->id);
    g_autoptr(GArray) ops = fl_array_of(Op, op_clear);
    Reader r = {svg, ops, MOST_ELEMENTS};
    const FlInherited s = fl_inherited_by(inheritance, node);
    const Around around = around_of(node);
    add_element(&r, node, &s, &around);
    return take_apart(ops, leaf->whole, parts);
}

void fl_svg_paint_clear(FlSvgPaint *paint)
{
    g_clear_pointer(&paint->key, g_free);
}
