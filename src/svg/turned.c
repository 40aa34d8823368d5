#include "svg/css_shapes.h"
#include "svg/passes.h"
#include <math.h>
#include <string.h>

#define MOST_REFERENCES 16 // from gradient to gradient
#define MOST_COPIED 100000 // elements; shapes beyond are as librsvg draws them

typedef struct Turned {
    GHashTable *ids; // id -> xmlNode, the first of that id
    FlCssUnits units;
    int n_made;   // names
    int n_copied; // elements in filters and patterns
    bool warped;  // a filter was seen that is not turned with its shape
} Turned;

static int count_elements(const xmlNode *node)
{
    int n = 0;
    FL_EACH_ELEMENT (child, node)
        n += 1 + count_elements(child);
    return n;
}

/* ---- filters --------------------------------------------------------------------------------- */

/** Gives a blur the two deviations that the map m, as librsvg applies it, makes equal. */
static void turn_blur(xmlNode *step, const FlAffine *m)
{
    const char *text = fl_attribute(step, "stdDeviation");
    double v[2];
    const int n = fl_numbers_read(text ? text : fl_is(step, "feDropShadow") ? "2" : "0", v, 2);
    if (n < 1 || (n == 2 && v[1] != v[0]))
        return; // librsvg has no blur across the axes
    const double determinant = m->xx * m->yy - m->xy * m->yx;
    const double px = v[0] * sqrt(fabs(determinant));
    for (int k = 0; k < 4; k++) { // the sign of a deviation does not count after the map
        const double x = k & 1 ? -1 : 1, y = k & 2 ? -1 : 1;
        const double a = (m->yy * x - m->xy * y) / determinant;
        const double b = (m->xx * y - m->yx * x) / determinant;
        if (a > -1e-9 && b > -1e-9)
            fl_set_numbers(step, "stdDeviation", (double[]){px * fmax(a, 0), px * fmax(b, 0)}, 2);
    }
}

/** Returns: true if librsvg draws a step upright where a browser turns it with its shape. */
static bool is_upright(const xmlNode *step)
{
    return xmlHasProp((xmlNode *)step, (xmlChar *)"width") ||
           fl_is_one_of(step, "feTurbulence feTile feImage feDisplacementMap feConvolveMatrix");
}

static bool holds_text(const xmlNode *node)
{
    bool found = fl_is(node, "text");
    FL_EACH_ELEMENT (child, node)
        found = found || holds_text(child);
    return found;
}

/** Cuts what a filter makes of a turned element to its region, which librsvg leaves upright. The
 * box of text is not known here. */
static void cut_region(Turned *t, xmlNode *node, xmlNode *filter)
{
    static const char *const names[] = {"x", "y", "width", "height"};
    const bool in_page = g_strcmp0(fl_attribute(filter, "filterUnits"), "userSpaceOnUse") == 0;
    FlCssBox box = {0, 0, t->units.width, t->units.height};
    if (fl_is_set(node, "clip-path") ||
        (!in_page && (holds_text(node) || !fl_css_fill_box(node, &t->units, &box))))
        return;
    g_autofree char *id = g_strdup_printf("fl-turned-%d", t->n_made++);
    xmlNode *clip = xmlNewDocNode(node->doc, node->ns, (const xmlChar *)"clipPath", NULL);
    xmlNode *region = xmlNewChild(clip, node->ns, (const xmlChar *)"rect", NULL);
    for (int i = 0; i < 4; i++) {
        const char *text = fl_attribute(filter, names[i]);
        const double side = i % 2 ? box.height : box.width, corner = i == 0 ? box.x : box.y;
        double v = 0;
        fl_css_number(text ? text : i < 2 ? "-10%" : "120%", &t->units, in_page ? side : 1, &v);
        v = in_page ? v : v * side + (i < 2 ? corner : 0);
        fl_set_numbers(region, names[i], &v, 1);
    }
    fl_set_attribute(clip, "id", id);
    xmlAddNextSibling(filter, clip);
    fl_declare(node, "clip-path:url(#%s)", id);
}

/** librsvg turns the deviations of a blur across and down like a way: at 45 degrees it blurs in one
 * direction only. What is turned gets a filter of its own, whose blurs come out round. */
static void mend_filter(Turned *t, xmlNode *node, const FlAffine *map)
{
    g_autofree char *value = fl_property(node, "filter");
    xmlNode *filter = fl_referred_by(value, "filter", t->ids);
    g_autofree char *units = filter ? fl_property(filter, "primitiveUnits") : NULL;
    const bool in_box = units && strcmp(units, "objectBoundingBox") == 0;
    bool blurs = false;
    FL_EACH_ELEMENT (step, filter) {
        blurs |= fl_is_one_of(step, "feGaussianBlur feDropShadow");
        t->warped |= in_box || is_upright(step);
    }
    if (filter)
        cut_region(t, node, filter);
    if (!filter || !blurs || in_box)
        return;
    g_autofree char *id = g_strdup_printf("fl-turned-%d", t->n_made++);
    xmlNode *turned = xmlAddNextSibling(filter, xmlDocCopyNode(filter, filter->doc, 1));
    fl_set_attribute(turned, "id", id);
    fl_declare(node, "filter:url(#%s)", id);
    t->n_copied += count_elements(turned);
    FL_EACH_ELEMENT (step, turned)
        if (fl_is_one_of(step, "feGaussianBlur feDropShadow"))
            turn_blur(step, map);
}

/* ---- paints in units of the box ------------------------------------------------------------ */

/** The first in a chain of paint servers that has an attribute; without `name`, that has content.
 */
static const xmlNode *server_with(const Turned *t, const xmlNode *server, const char *name)
{
    for (int k = 0; server && k < MOST_REFERENCES; k++) {
        g_autofree char *href = fl_href(server);
        if (name ? fl_attribute(server, name) != NULL
                 : xmlFirstElementChild((xmlNode *)server) != NULL)
            return server;
        server = href && *href == '#' ? g_hash_table_lookup(t->ids, href + 1) : NULL;
    }
    return NULL;
}

static const char *server_attribute(const Turned *t, const xmlNode *server, const char *name)
{
    const xmlNode *with = server_with(t, server, name);
    return with ? fl_attribute(with, name) : NULL;
}

/** Returns: true if an attribute says, or is missing and stands for, objectBoundingBox. */
static bool is_in_box(const Turned *t, const xmlNode *server, const char *name, bool missing)
{
    const char *units = server_attribute(t, server, name);
    return units ? strcmp(units, "objectBoundingBox") == 0 : missing;
}

/** Sets an attribute that is a share of a side to a number: from + side * share. */
static void set_share(const Turned *t, xmlNode *own, const xmlNode *server, const char *name,
                      const char *missing, double from, double side)
{
    const FlCssUnits none = {0};
    const char *text = server_attribute(t, server, name);
    double share;
    if (!(text || missing) || !fl_css_number(text ? text : missing, &none, 1, &share))
        return;
    share = from + side * share;
    fl_set_numbers(own, name, &share, 1);
}

/** Places a gradient by its transform. */
static void place_gradient(const Turned *t, xmlNode *own, const xmlNode *server, FlCssBox box)
{
    static const char *const shares[][2] = {{"x1", "0"},  {"y1", "0"},  {"x2", "1"}, {"y2", "0"},
                                            {"cx", ".5"}, {"cy", ".5"}, {"r", ".5"}, {"fx", NULL},
                                            {"fy", NULL}, {"fr", NULL}};
    const FlAffine place = {box.width, 0, 0, box.height, box.x, box.y};
    const char *transform = server_attribute(t, server, "gradientTransform");
    FlAffine turn = FL_AFFINE_NONE;
    if (transform)
        fl_affine_parse(transform, &turn);
    fl_set_attribute(own, "gradientUnits", "userSpaceOnUse");
    fl_set_affine(own, "gradientTransform", fl_affine_multiply(place, turn));
    for (size_t i = 0; i < G_N_ELEMENTS(shares); i++)
        set_share(t, own, server, shares[i][0], shares[i][1], 0, 1);
}

/** Places the tiles of a pattern, and maps their content into them. */
static void place_pattern(const Turned *t, xmlNode *own, const xmlNode *server, FlCssBox box)
{
    static const char *const names[] = {"x", "y", "width", "height"};
    const double corner[] = {box.x, box.y, 0, 0}, side[] = {box.width, box.height};
    const xmlNode *content = server_with(t, server, NULL);
    const xmlNode *viewed = server_with(t, server, "viewBox");
    const bool in_box = is_in_box(t, server, "patternUnits", true);
    FlAffine map = {box.width, 0, 0, box.height, 0, 0};
    double view[4];
    for (int i = 0; i < 4; i++)
        if (in_box)
            set_share(t, own, server, names[i], "0", corner[i], side[i % 2]);
        else
            fl_set_attribute(own, names[i], server_attribute(t, server, names[i]));
    fl_set_attribute(own, "patternUnits", "userSpaceOnUse");
    if (viewed && fl_view_box(viewed, view))
        map = fl_fit_box(view, fl_length_of(own, "width", &t->units, t->units.width),
                         fl_length_of(own, "height", &t->units, t->units.height),
                         server_attribute(t, server, "preserveAspectRatio"));
    else if (!is_in_box(t, server, "patternContentUnits", false))
        return;
    if (!content)
        return;
    xmlNode *group = xmlNewChild(own, own->ns, (const xmlChar *)"g", NULL);
    xmlAddChildList(group, xmlDocCopyNodeList(own->doc, content->children));
    fl_set_affine(group, "transform", map);
    fl_set_attribute(own, "patternTransform", server_attribute(t, server, "patternTransform"));
    fl_set_attribute(own, "patternContentUnits", "userSpaceOnUse");
    fl_set_attribute(own, "viewBox", NULL);
    fl_drop_href(own);
}

/** librsvg takes the box of a turned shape for that of its picture, and draws no pattern whose
 * viewBox has other proportions than its tile: the shape gets a paint of its own in user units. */
static void mend_paint(Turned *t, xmlNode *node, const char *property, bool turned)
{
    g_autofree char *value = fl_inherited_property(node, property);
    xmlNode *server = fl_referred_by(value, "linearGradient radialGradient pattern", t->ids);
    const bool pattern = server && fl_is(server, "pattern");
    const bool in_box = server && (pattern ? is_in_box(t, server, "patternUnits", true) ||
                                                 is_in_box(t, server, "patternContentUnits", false)
                                           : is_in_box(t, server, "gradientUnits", true));
    const bool viewed = pattern && server_with(t, server, "viewBox");
    const char *id = viewed || (in_box && turned) ? fl_attribute(server, "id") : NULL;
    FlCssBox box;
    if (!id || !fl_css_fill_box(node, &t->units, &box) || !(box.width > 0 && box.height > 0))
        return;
    g_autofree char *name = g_strdup_printf("fl-turned-%d", t->n_made++);
    g_autofree char *href = g_strconcat("#", id, NULL);
    xmlNode *own = xmlDocCopyNode(server, node->doc, 2); // with its namespaces, without content
    fl_set_attribute(own, "id", name);
    fl_set_attribute(own, "href", href);
    (pattern ? place_pattern : place_gradient)(t, own, server, box);
    xmlAddNextSibling(server, own);
    t->n_copied += count_elements(own);
    fl_declare(node, "%s:url(#%s)", property, name);
}

/* ---- the document ---------------------------------------------------------------------------- */

static void visit(Turned *t, xmlNode *node, const FlAffine *around)
{
    const FlAffine map = fl_affine_multiply(*around, fl_affine_of(node));
    const bool upright = (map.xy == 0 && map.yx == 0) || (map.xx == 0 && map.yy == 0);
    const bool turned = !upright && map.xx * map.yy != map.xy * map.yx;
    if (turned && t->n_copied < MOST_COPIED)
        mend_filter(t, node, &map);
    if (t->n_copied < MOST_COPIED &&
        fl_is_one_of(node, "path rect circle ellipse line polyline polygon")) {
        mend_paint(t, node, "fill", turned);
        mend_paint(t, node, "stroke", turned);
    }
    FL_EACH_ELEMENT (child, node)
        visit(t, child, &map);
}

void fl_document_mend_turned(xmlDoc *doc, GHashTable *ids, const char *path, int number,
                             FlWarnings *warnings)
{
    xmlNode *root = xmlDocGetRootElement(doc);
    double box[4] = {0, 0, 300, 150};
    fl_view_box(root, box);
    Turned t = {.ids = ids, .units = {.width = box[2], .height = box[3]}};
    visit(&t, root, &FL_AFFINE_NONE);
    if (t.n_copied >= MOST_COPIED)
        fl_warnings_add(warnings, path, number, NULL,
                        "too many turned shapes have a blur or a pattern; those of the rest may "
                        "look wrong");
    if (t.warped)
        fl_warnings_add(
            warnings, path, number, NULL,
            "filter: its texture or region is drawn upright, not turned with its shape");
}
