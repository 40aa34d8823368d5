#include "svg/layer_frames.h"

#include "base/error.h"
#include <string.h>

static bool is_marked(const xmlNode *node)
{
    g_autofree char *mode = fl_foreign_attribute(node, "groupmode");
    return mode && (strcmp(mode, "layer") == 0 || strcmp(mode, "frame") == 0);
}

static bool is_static(const xmlNode *node)
{
    g_autofree char *label = fl_foreign_attribute(node, "label");
    g_autofree char *lower = label ? g_ascii_strdown(label, -1) : NULL;
    return lower && strstr(lower, "(static)");
}

/** The groups of a parent that are frames, bottom up; to be unref'd. */
static GPtrArray *frames_in(const xmlNode *parent)
{
    GPtrArray *frames = g_ptr_array_new();
    bool marked = false;
    for (xmlNode *child = parent->children; child; child = child->next)
        marked = marked || (fl_is(child, "g") && is_marked(child));
    for (xmlNode *child = parent->children; child; child = child->next)
        if (fl_is(child, "g") && (!marked || is_marked(child)) && !is_static(child))
            g_ptr_array_add(frames, child);
    return frames;
}

/** The frames of a document: those of the innermost only group, if that has several. */
static GPtrArray *frames_of(const xmlDoc *doc)
{
    GPtrArray *frames = frames_in(xmlDocGetRootElement(doc));
    while (frames->len == 1) {
        GPtrArray *inner = frames_in(frames->pdata[0]);
        if (inner->len == 0) {
            g_ptr_array_unref(inner);
            break;
        }
        g_ptr_array_unref(frames);
        frames = inner;
    }
    return frames;
}

int fl_layer_frames_count(const xmlDoc *doc)
{
    g_autoptr(GPtrArray) frames = frames_of(doc);
    return (int)frames->len;
}

/** Shows a layer that was hidden when the document was saved. */
static void show(xmlNode *layer)
{
    fl_set_attribute(layer, "display", NULL);
    fl_declare(layer, "display:inline");
}

static void drop_names(xmlNode *layer)
{
    for (xmlAttr *a = layer->properties, *next; a; a = next) {
        const char *colon = strchr((const char *)a->name, ':');
        const char *name = colon ? colon + 1 : (const char *)a->name;
        next = a->next;
        if (strcmp(name, "id") == 0 || strcmp(name, "label") == 0 || strcmp(name, "groupmode") == 0)
            xmlRemoveProp(a);
    }
}

/** Returns: true if an element shows another one by reference, as Inkscape's clones do. */
static bool has_clones(const xmlNode *node)
{
    bool found = fl_is(node, "use");
    for (const xmlNode *child = node->children; child && !found; child = child->next)
        found = child->type == XML_ELEMENT_NODE && has_clones(child);
    return found;
}

/** Takes a layer out of the picture. Where there are clones it stays as a definition. */
static void put_away(xmlNode *layer, xmlNode *definitions)
{
    xmlUnlinkNode(layer);
    if (definitions)
        xmlAddChild(definitions, layer);
    else
        xmlFreeNode(layer);
}

bool fl_layer_frames_select(xmlDoc *doc, int frame, const char *path, GError **error)
{
    g_autoptr(GPtrArray) frames = frames_of(doc);
    if (frame < 1 || frame > (int)frames->len)
        return fl_fail(error, FL_ERROR_INPUT, "%s: no layer for frame %d; there are %u", path,
                       frame, frames->len);
    xmlNode *root = xmlDocGetRootElement(doc), *shown = frames->pdata[frame - 1];
    xmlNode *definitions =
        has_clones(root) ? xmlNewChild(root, root->ns, (const xmlChar *)"defs", NULL) : NULL;
    for (guint i = 0; i < frames->len; i++)
        if (frames->pdata[i] != shown)
            put_away(frames->pdata[i], definitions);
    show(shown), drop_names(shown);
    for (xmlNode *above = shown->parent; fl_is(above, "g"); above = above->parent)
        show(above);
    return true;
}

static int moves_at(const xmlNode *node)
{
    const long line = MAX(xmlGetLineNo(node), 1);
    if (fl_is_animation(node))
        return (int)line;
    if (fl_is(node, "style")) {
        g_autoptr(xmlChar) css = xmlNodeGetContent(node);
        return css && strstr((const char *)css, "@keyframes") ? (int)line : 0;
    }
    for (const xmlNode *child = node->children; child; child = child->next) {
        const int at = child->type == XML_ELEMENT_NODE ? moves_at(child) : 0;
        if (at > 0)
            return at;
    }
    return 0;
}

int fl_document_moves(const xmlDoc *doc)
{
    return moves_at(xmlDocGetRootElement(doc));
}
