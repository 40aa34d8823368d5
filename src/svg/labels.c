#include "svg/labels.h"

#include "svg/document.h"
#include <glib.h>
#include <string.h>

/** Whether s, in lower case, is a random id: hexadecimal digits and dashes, sixteen or more. */
static bool is_random(const char *s)
{
    size_t digits = 0;
    for (; *s; s++) {
        if (g_ascii_isxdigit(*s))
            digits++;
        else if (*s != '-' && *s != '_')
            return false;
    }
    return digits >= 16;
}

bool fl_label_is_generic(const char *name)
{
    static const char *const words[] = {
        "g",       "group",         "path",      "shape",     "rect",     "rectangle",
        "ellipse", "circle",        "line",      "svg",       "svgid",    "layer",
        "sprite",  "use",           "text",      "tspan",     "image",    "clip",
        "mask",    "fill",          "stroke",    "polygon",   "polyline", "xmlid",
        "object",  "compound path", "clip-path", "clip path", "frame",    "page",
        "canvas",  "artboard",      "symbol",    "surface",   "vector",   "union",
        "svgjsg",  "mask group",    "",          NULL};
    g_autofree char *lower = g_ascii_strdown(name, -1);
    if (g_str_has_prefix(lower, "__lottie") || g_str_has_prefix(lower, "fl-leaf-"))
        return true;
    if (g_str_has_suffix(name, "_FILL") || g_str_has_suffix(name, "_STROKES")) // Animate
        return true;
    if (g_str_has_prefix(lower, "shape-") && is_random(lower + 6)) // Penpot
        return true;
    if (is_random(lower))
        return true;
    size_t n = strlen(lower);
    while (n > 0 && strchr("0123456789-_ .:", lower[n - 1]))
        n--;
    lower[n] = '\0';
    return g_strv_contains(words, lower);
}

/** Decodes characters that ids cannot have: "arm_x20_left", or CorelDRAW's "arm_x0020_left". */
static void decode(char *name)
{
    char *out = name;
    for (const char *in = name; *in;) {
        char *end = NULL;
        const bool escape = in[0] == '_' && in[1] == 'x' && g_ascii_isxdigit(in[2]);
        const gint64 code = escape ? g_ascii_strtoll(in + 2, &end, 16) : 0;
        if (escape && *end == '_' && code >= 0x20 && code < 0x7f) {
            *out++ = (char)code;
            in = end + 1;
        } else {
            *out++ = *in++;
        }
    }
    *out = '\0';
}

/** Cuts Illustrator's suffix of a repeated name: "tree_3_" is "tree". */
static void cut_repeat(char *name)
{
    size_t n = strlen(name);
    if (n < 3 || name[n - 1] != '_' || !g_ascii_isdigit(name[n - 2]))
        return;
    n--;
    while (n > 0 && g_ascii_isdigit(name[n - 1]))
        n--;
    if (n > 1 && name[n - 1] == '_')
        name[n - 1] = '\0';
}

/** An attribute by its local name, with any prefix, be it declared or not. */
static char *foreign_attribute(const xmlNode *node, const char *name)
{
    for (xmlAttr *a = node->properties; a; a = a->next) {
        const char *colon = strchr((const char *)a->name, ':');
        if ((a->ns || colon) && strcmp(colon ? colon + 1 : (const char *)a->name, name) == 0) {
            xmlChar *value = xmlNodeListGetString(node->doc, a->children, 1);
            char *copy = g_strdup(value ? (const char *)value : "");
            xmlFree(value);
            return g_strstrip(copy);
        }
    }
    return NULL;
}

/** Blender writes <!--Layer: Fills--> before the group of a layer. */
static bool follows_layer_comment(const xmlNode *node)
{
    const xmlNode *before = node->prev;
    while (before && before->type == XML_TEXT_NODE)
        before = before->prev;
    return before && before->type == XML_COMMENT_NODE &&
           g_str_has_prefix((const char *)before->content, "Layer:");
}

/** The text of a <title> in it, by which SVG-edit names layers; NULL if none. */
static char *title_of(const xmlNode *node)
{
    for (const xmlNode *child = node->children; child; child = child->next)
        if (fl_is(child, "title")) {
            g_autoptr(xmlChar) text = xmlNodeGetContent(child);
            return text ? g_strstrip(g_strdup((const char *)text)) : NULL;
        }
    return NULL;
}

/** The first of the names that programs keep beside the unique ids; "" if none. */
static char *name_of(const xmlNode *node, const char *id)
{
    static const char *const foreign[] = {"label", "characterName", "layerName", NULL};
    for (int i = 0; foreign[i]; i++) {
        g_autofree char *name = foreign_attribute(node, foreign[i]);
        if (name && name[0])
            return g_steal_pointer(&name);
    }
    g_autofree char *affinity = foreign_attribute(node, "id");
    g_autoptr(xmlChar) adobe = (xmlChar *)fl_attribute(node, "data-name");
    g_autofree char *title = id && !fl_label_is_generic(id) ? NULL : title_of(node);
    const char *name = affinity && affinity[0] ? affinity
                       : adobe && adobe[0]     ? (const char *)adobe
                       : title && title[0]     ? title
                       : id                    ? id
                                               : "";
    return g_strdup(name);
}

char *fl_label_of(const xmlNode *node, const char *id, bool *is_layer)
{
    static const char *const groups[] = {"g", "svg", "a", "use", NULL};
    *is_layer = false;
    if (!g_strv_contains(groups, (const char *)node->name))
        return NULL;
    g_autofree char *mode = foreign_attribute(node, "groupmode");
    g_autofree char *label = foreign_attribute(node, "label");
    *is_layer = (mode && strcmp(mode, "layer") == 0) || follows_layer_comment(node);
    char *name = name_of(node, id);
    decode(name);
    cut_repeat(name);
    for (char *c = name; *c; c++)
        if (*c == '/' || *c == '\n')
            *c = ' ';
    if (!name[0] || (fl_label_is_generic(name) && !(*is_layer && label && label[0]))) {
        g_free(name);
        return NULL;
    }
    return name;
}
