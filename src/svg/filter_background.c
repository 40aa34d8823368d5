#include "svg/passes.h"

#include <string.h>

#define EMPTY "fl-background" // the result in place of the background

static bool is_background(const char *name)
{
    return name && (strcmp(name, "BackgroundImage") == 0 || strcmp(name, "BackgroundAlpha") == 0);
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

/** Makes inputs of a filter that are the background EMPTY. Returns: true if it had any. */
static bool replace_inputs(xmlNode *filter)
{
    bool found = false;
    FL_EACH_ELEMENT (child, filter) {
        for (const char *input; (input = background_input(child)); found = true)
            fl_set_attribute(child, input, EMPTY);
        found = replace_inputs(child) || found;
    }
    return found;
}

/** The mode of a filter that only blends with the background, or NULL; to be freed. */
static char *blend_mode(xmlNode *filter)
{
    xmlNode *only = xmlFirstElementChild(filter);
    if (!only || !fl_is(only, "feBlend") || xmlNextElementSibling(only))
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
    xmlNode *first = xmlFirstElementChild(filter);
    if (!replace_inputs(filter))
        return false;
    xmlNode *flood = xmlNewDocNode(filter->doc, filter->ns, (const xmlChar *)"feFlood", NULL);
    fl_set_attribute(flood, "flood-opacity", "0");
    fl_set_attribute(flood, "result", EMPTY);
    if (!xmlHasProp(first, (const xmlChar *)"in")) // its input was not the flood
        fl_set_attribute(first, "in", "SourceGraphic");
    xmlAddPrevSibling(first, flood);
    return true;
}

/** Visits a node and the filters in it; `modes` gets "url(#id)" -> mode of those that only blend.
 */
static bool change_filters(xmlNode *node, GHashTable *modes)
{
    bool emptied = false;
    g_autofree char *mode = fl_is(node, "filter") ? blend_mode(node) : NULL;
    g_autoptr(xmlChar) id = fl_attribute(node, "id");
    if (mode && id)
        g_hash_table_replace(modes, g_strdup_printf("url(#%s)", (const char *)id),
                             g_steal_pointer(&mode));
    else if (fl_is(node, "filter"))
        return empty_background(node);
    FL_EACH_ELEMENT (child, node)
        emptied = change_filters(child, modes) || emptied;
    return emptied;
}

static void set_modes(xmlNode *node, GHashTable *modes)
{
    g_autofree char *filter = fl_property(node, "filter");
    const char *mode = filter ? g_hash_table_lookup(modes, filter) : NULL;
    g_autofree char *style = mode ? g_strdup_printf("filter:none;mix-blend-mode:%s", mode) : NULL;
    if (style)
        fl_declare(node, style);
    FL_EACH_ELEMENT (child, node)
        set_modes(child, modes);
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
