#include "svg/passes.h"

#include <string.h>

#define EMPTY "fl-background" // the result in place of the background

static bool is_background(const char *name)
{
    return name && (strcmp(name, "BackgroundImage") == 0 || strcmp(name, "BackgroundAlpha") == 0);
}

static xmlNode *first_element(xmlNode *node)
{
    while (node && node->type != XML_ELEMENT_NODE)
        node = node->next;
    return node;
}

/** The attribute by which an element reads the background; NULL for other elements. */
static const char *background_input(const xmlNode *node)
{
    static const char *const inputs[] = {"in", "in2"};
    for (size_t i = 0; i < G_N_ELEMENTS(inputs); i++) {
        g_autoptr(xmlChar) value = fl_attribute(node, inputs[i]);
        if (is_background((const char *)value))
            return inputs[i];
    }
    return NULL;
}

/** Makes inputs that are the background EMPTY. Returns: whether there were any. */
static bool replace_inputs(xmlNode *node)
{
    bool found = false;
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        for (const char *input; (input = background_input(node)); found = true)
            fl_set_attribute(node, input, EMPTY);
        found = replace_inputs(node->children) || found;
    }
    return found;
}

/** The mode of a filter that only blends with the background, or NULL; to be freed. */
static char *blend_mode(xmlNode *filter)
{
    xmlNode *only = first_element(filter->children);
    if (!only || !fl_is(only, "feBlend") || first_element(only->next))
        return NULL;
    g_autoptr(xmlChar) in = fl_attribute(only, "in");
    g_autoptr(xmlChar) in2 = fl_attribute(only, "in2");
    g_autoptr(xmlChar) mode = fl_attribute(only, "mode");
    if (!is_background((const char *)in2) || (in && !xmlStrEqual(in, (xmlChar *)"SourceGraphic")))
        return NULL;
    return g_strdup(mode ? (const char *)mode : "normal");
}

/** Puts an empty picture in place of the background. Returns: true if the filter read the
 * background. */
static bool empty_background(xmlNode *filter)
{
    xmlNode *first = first_element(filter->children);
    if (!first || !replace_inputs(first))
        return false;
    xmlNode *flood = xmlNewDocNode(filter->doc, filter->ns, (const xmlChar *)"feFlood", NULL);
    fl_set_attribute(flood, "flood-opacity", "0");
    fl_set_attribute(flood, "result", EMPTY);
    if (!xmlHasProp(first, (const xmlChar *)"in")) // its input was not the flood
        fl_set_attribute(first, "in", "SourceGraphic");
    xmlAddPrevSibling(first, flood);
    return true;
}

/** Visits the filters from node on; `modes` gets "url(#id)" -> mode of those that only blend. */
static bool change_filters(xmlNode *node, GHashTable *modes)
{
    bool emptied = false;
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        g_autofree char *mode = fl_is(node, "filter") ? blend_mode(node) : NULL;
        g_autoptr(xmlChar) id = fl_attribute(node, "id");
        if (mode && id)
            g_hash_table_replace(modes, g_strdup_printf("url(#%s)", (const char *)id),
                                 g_steal_pointer(&mode));
        else if (fl_is(node, "filter"))
            emptied = empty_background(node) || emptied;
        else
            emptied = change_filters(node->children, modes) || emptied;
    }
    return emptied;
}

static void set_modes(xmlNode *node, GHashTable *modes)
{
    for (; node; node = node->next) {
        if (node->type != XML_ELEMENT_NODE)
            continue;
        g_autofree char *filter = fl_property(node, "filter");
        const char *mode = filter ? g_hash_table_lookup(modes, filter) : NULL;
        if (mode) {
            g_autofree char *style = g_strdup_printf("filter:none;mix-blend-mode:%s", mode);
            fl_declare(node, style);
        }
        set_modes(node->children, modes);
    }
}

void fl_document_drop_background(xmlDoc *doc, const char *path, int number, FlWarnings *warnings)
{
    g_autoptr(GHashTable) modes = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, g_free);
    if (change_filters(xmlDocGetRootElement(doc), modes))
        fl_warnings_add(warnings, path, number, NULL,
                        "BackgroundImage is empty: filters cannot read what is below");
    if (g_hash_table_size(modes) > 0)
        set_modes(xmlDocGetRootElement(doc), modes);
}
