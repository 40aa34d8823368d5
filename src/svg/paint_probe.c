#include "svg/paint_probe.h"

#include "svg/effects.h"
#include "svg/normalise.h"

#include <string.h>

static const char *const shapes[] = {"g",      "svg",     "a",    "path",     "rect",
                                     "circle", "ellipse", "line", "polyline", "polygon",
                                     "text",   "image",   "use",  NULL};

static bool is_in_marker(const xmlNode *node)
{
    while (node && !fl_is(node, "marker"))
        node = node->parent;
    return node != NULL;
}

/** Returns: true if a node may cause librsvg to draw any leaf on a separate surface; defined: the
 * node is part of a definition. */
static bool is_apart(const xmlNode *node, bool defined)
{
    static const char *const anywhere[] = {"pattern", NULL};
    g_autoptr(xmlChar) units = fl_attribute(node, "clipPathUnits");
    return fl_is_one_of(node, anywhere) ||
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

static void drop_masks(xmlNode *node)
{
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        g_autoptr(xmlChar) style = fl_attribute(node, "style");
        if (fl_is_one_of(node, shapes) && style && strstr((const char *)style, "mask"))
            fl_declare(node, "mask:none");
        xmlUnsetProp(node, (const xmlChar *)"mask");
        drop_masks(node->children);
    }
}

void fl_paint_probe_prepare(xmlDoc *doc)
{
    xmlNode *root = xmlDocGetRootElement(doc);
    drop_masks(root);
    shrink_images(root);
    turn_children(root);
    turn_patterns(root->children);
}
