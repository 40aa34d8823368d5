#include "frames/labels.h"

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
        "canvas",  "artboard",      "",          NULL};
    g_autofree char *lower = g_ascii_strdown(name, -1);
    if (g_str_has_prefix(lower, "__lottie") || g_str_has_prefix(lower, "fl-leaf-"))
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

/** Cuts Illustrator's mark of a repeated name: "tree_3_" is "tree". */
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

char *fl_label_of(const xmlNode *node, const char *id, bool *is_layer)
{
    static const char *const groups[] = {"g", "svg", "a", "use", NULL};
    *is_layer = false;
    if (!g_strv_contains(groups, (const char *)node->name))
        return NULL;
    g_autofree char *mode = foreign_attribute(node, "groupmode");
    g_autofree char *label = foreign_attribute(node, "label");
    g_autofree char *character = foreign_attribute(node, "characterName");
    *is_layer = (mode && strcmp(mode, "layer") == 0) || follows_layer_comment(node);
    char *name = g_strdup(label && label[0]           ? label
                          : character && character[0] ? character
                          : id                        ? id
                                                      : "");
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
