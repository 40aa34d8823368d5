#include "svg/group_mask.h"

/*
 * librsvg applies a group's mask only if it renders that group or an outer one as a layer: it
 * cannot draw a single leaf of the group with the mask. Leaves are therefore drawn without the
 * masks of their groups, and each mask is drawn once.
 */

#define FLOOD_ID "fl-flood"
#define PLAIN "opacity:1 !important;mix-blend-mode:normal !important;isolation:auto !important;"

static xmlNode *group_of(GHashTable *ids, const FlGroupMask *mask)
{
    return g_hash_table_lookup(ids, mask->group);
}

/** The element around a node; NULL around the root. */
static xmlNode *outwards(const xmlNode *node)
{
    return node->parent && node->parent->type == XML_ELEMENT_NODE ? node->parent : NULL;
}

/** Adds declarations to a node and its ancestors, up to the first that already has them. */
static void declare_outwards(xmlNode *node, const char *declarations)
{
    while (node && fl_declare(node, declarations))
        node = outwards(node);
}

void fl_group_masks_drop(xmlDoc *doc, const FlLeaves *leaves)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    for (guint i = 0; i < leaves->mask->len; i++) {
        xmlNode *node = group_of(ids, &g_array_index(leaves->mask, FlGroupMask, i));
        fl_declare(node, "mask:none !important");
        declare_outwards(node, "clip-path:none !important");
    }
}

/** A filter that fills the page, whatever the shapes of what it is applied to. */
static void add_flood(xmlDoc *doc)
{
    static const char *const attributes[][2] = {{"id", FLOOD_ID}, {"filterUnits", "userSpaceOnUse"},
                                                {"x", "-1e6"},    {"y", "-1e6"},
                                                {"width", "2e6"}, {"height", "2e6"}};
    xmlNode *root = xmlDocGetRootElement(doc);
    xmlNode *filter = xmlNewChild(root, root->ns, (const xmlChar *)"filter", NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(attributes); i++)
        fl_set_attribute(filter, attributes[i][0], attributes[i][1]);
    xmlNewChild(filter, root->ns, (const xmlChar *)"feFlood", NULL);
}

void fl_group_masks_flood(xmlDoc *doc, const FlLeaves *leaves, int depth)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    add_flood(doc);
    for (guint i = 0; i < leaves->mask->len; i++) {
        const FlGroupMask *mask = &g_array_index(leaves->mask, FlGroupMask, i);
        if (mask->depth != depth)
            continue;
        xmlNode *node = group_of(ids, mask);
        // the hidden content still determines the box; librsvg ignores !important for filters
        fl_declare(node, PLAIN "visibility:hidden !important;filter:url(#" FLOOD_ID ")");
        declare_outwards(outwards(node), PLAIN "mask:none !important;filter:none !important");
    }
}
