#include "svg/paint_probe.h"

#include "svg/effects.h"
#include "svg/normalise.h"

#include <math.h>
#include <string.h>

#define VAST 30 // pages; at 39 cairo's script surface aborts

static const char *const shapes[] = {"g",      "svg",     "a",    "path",     "rect",
                                     "circle", "ellipse", "line", "polyline", "polygon",
                                     "text",   "image",   "use",  NULL};

static bool is_in_marker(const xmlNode *node)
{
    while (node && !fl_is(node, "marker"))
        node = node->parent;
    return node != NULL;
}

/** The largest number in a text, by magnitude. */
static double largest_number(const char *text)
{
    double largest = 0;
    for (const char *s = text; s && *s;) {
        char *end;
        const double number = g_ascii_strtod(s, &end);
        largest = fmax(largest, fabs(number));
        s = end > s ? end : s + 1;
    }
    return largest;
}

/** The larger side of the page in user space, about. */
static double page_side(const xmlNode *root)
{
    static const char *const names[] = {"viewBox", "width", "height"};
    double side = 1;
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        g_autoptr(xmlChar) value = fl_attribute(root, names[i]);
        side = fmax(side, largest_number((const char *)value));
    }
    return side;
}

/** Returns: true if shapes of a clip path reach far beyond the page. */
static bool is_vast(const xmlNode *shape, double side)
{
    for (; shape; shape = shape->next)
        for (const xmlAttr *a = shape->type == XML_ELEMENT_NODE ? shape->properties : NULL; a;
             a = a->next) {
            g_autoptr(xmlChar) value = xmlNodeListGetString(shape->doc, a->children, 1);
            if (largest_number((const char *)value) > VAST * side)
                return true;
        }
    return false;
}

/** Returns: true if a node may cause librsvg to draw any leaf on a separate surface, or cairo's
 * script surface to fail; defined: the node is part of a definition. */
static bool is_apart(const xmlNode *node, bool defined)
{
    static const char *const anywhere[] = {"pattern", NULL};
    g_autoptr(xmlChar) units = fl_attribute(node, "clipPathUnits");
    return fl_is_one_of(node, anywhere) ||
           (fl_is(node, "clipPath") &&
            is_vast(node->children, page_side(xmlDocGetRootElement(node->doc)))) ||
           (units && strcmp((const char *)units, "objectBoundingBox") == 0) ||
           (defined && (fl_is(node, "image") || fl_has_effects(node) ||
                        (fl_is(node, "use") && is_in_marker(node))));
}

/** The same of the nodes from one on. What is in a mask is drawn for leaves that have one, which
 * FlLeaf.effects tells. */
static bool has_apart(const xmlNode *node, bool defined)
{
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        const bool within = (defined || fl_is_undrawn(node)) && !fl_is(node, "mask");
        if (is_apart(node, within) || has_apart(node->children, within))
            return true;
    }
    return false;
}

bool fl_paint_probe_is_needed(xmlDoc *doc)
{
    return has_apart(xmlDocGetRootElement(doc), false);
}

/** Makes every image one grey pixel. */
static void shrink_images(xmlNode *node)
{
    static const char *const pixel =
        "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAAAAAA6fptVAAAACklEQVR4nGNoAAAAggCB"
        "d81ytgAAAABJRU5ErkJggg==";
    for (; node; node = node->next) {
        if (fl_is(node, "image")) {
            xmlNs *xlink =
                xmlSearchNsByHref(node->doc, node, (const xmlChar *)"http://www.w3.org/1999/xlink");
            xmlUnsetNsProp(node, xlink, (const xmlChar *)"href");
            xmlSetProp(node, (const xmlChar *)"href", (const xmlChar *)pixel);
        }
        if (node->type == XML_ELEMENT_NODE)
            shrink_images(node->children);
    }
}

/** Rotates the children of a node about its centre, if its viewBox has one. */
static void turn_children(xmlNode *node)
{
    g_autoptr(xmlChar) view = fl_attribute(node, "viewBox");
    double box[4] = {0};
    char *s = (char *)view;
    for (int i = 0; s && i < 4; i++) {
        box[i] = g_ascii_strtod(s + strspn(s, ", \t\r\n"), &s);
    }
    char n[3][G_ASCII_DTOSTR_BUF_SIZE];
    g_autofree char *turn = g_strdup_printf(
        "rotate(%s %s %s)", g_ascii_dtostr(n[0], sizeof n[0], FL_PAINT_PROBE_TURN * 180 / G_PI),
        g_ascii_dtostr(n[1], sizeof n[1], box[0] + box[2] / 2),
        g_ascii_dtostr(n[2], sizeof n[2], box[1] + box[3] / 2));
    for (xmlNode *child = node->children; child; child = child->next) {
        if (!fl_is_one_of(child, shapes))
            continue;
        g_autoptr(xmlChar) own = fl_attribute(child, "transform");
        g_autofree char *both = g_strconcat(turn, " ", own ? (const char *)own : "", NULL);
        xmlSetProp(child, (const xmlChar *)"transform", (const xmlChar *)both);
    }
}

static void turn_patterns(xmlNode *node)
{
    for (; node; node = node->next) {
        if (fl_is(node, "pattern"))
            turn_children(node);
        else if (node->type == XML_ELEMENT_NODE)
            turn_patterns(node->children);
    }
}

/** Drops masks and clip paths. */
static void uncover(xmlNode *node)
{
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        g_autoptr(xmlChar) style = fl_attribute(node, "style");
        if (fl_is_one_of(node, shapes) && style &&
            (strstr((const char *)style, "mask") || strstr((const char *)style, "clip-path")))
            fl_declare(node, "mask:none;clip-path:none");
        xmlUnsetProp(node, (const xmlChar *)"mask");
        xmlUnsetProp(node, (const xmlChar *)"clip-path");
        uncover(node->children);
    }
}

void fl_paint_probe_prepare(xmlDoc *doc)
{
    xmlNode *root = xmlDocGetRootElement(doc);
    uncover(root);
    shrink_images(root);
    turn_children(root);
    turn_patterns(root->children);
}
