#include "base/error.h"
#include "svg/svg_data.h"
#include <string.h>

/** Sentences for librsvg's and cairo's bare error names. */
static const char *plain_words(const char *message)
{
    static const char *const words[][2] = {
        {"NoMemory", "librsvg reports no memory: a filter failed, or the picture is too large"},
        {"FreetypeError", "a text is too large, or its font is broken"},
        {"InvalidSize", "a picture in it would be too large"},
        {"InvalidMatrix", "a transform in it cannot be inverted"},
        {"InstancingLimit", "<use> or patterns in it show too many elements"},
        {"MaxReferencesExceeded", "<use> or patterns in it show too many elements"},
        {"XML_ERR_INTERNAL_ERROR", "it is not well-formed"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(words); i++)
        if (strstr(message, words[i][0]))
            return words[i][1];
    return message;
}

void fl_svg_set_error(const FlSvg *svg, const GError *reason, GError **error)
{
    g_autofree char *text = g_strchomp(g_strdup(reason ? reason->message : "unknown error"));
    const char *message = plain_words(text);
    fl_fail(error, FL_ERROR_INPUT, "%s: cannot be drawn: %s", svg->path, message);
}

RsvgHandle *fl_svg_make_handle(const FlSvg *svg, const char *text, size_t bytes, GError **error)
{
    g_autoptr(GError) reason = NULL;
    g_autoptr(GFile) file = g_file_new_for_path(svg->path);
    g_autoptr(GInputStream) stream = g_memory_input_stream_new_from_data(text, (gssize)bytes, NULL);
    const RsvgHandleFlags flags =
        fl_document_is_huge(bytes) ? RSVG_HANDLE_FLAG_UNLIMITED : RSVG_HANDLE_FLAGS_NONE;
    RsvgHandle *handle = rsvg_handle_new_from_stream_sync(stream, file, flags, NULL, &reason);
    if (!handle)
        fl_svg_set_error(svg, reason, error);
    else
        rsvg_handle_set_dpi(handle, svg->dpi);
    return handle;
}

/* ---- masks of groups ------------------------------------------------------------------------- */

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

/** Adds declarations to a node and its ancestors, up to the first that already has them. */
static void declare_outwards(xmlNode *node, const char *declarations)
{
    while (node && fl_declare(node, "%s", declarations))
        node = fl_element_around(node);
}

/** Takes masks and clips off the groups of leaves->mask, and clips off those around them. */
static void drop_masks(xmlDoc *doc, const FlLeaves *leaves)
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

/**
 * Changes the document so that each group of that depth, rendered as a layer, shows the coverage of
 * its mask and of the clips on the group and around: the group is flooded, all other content is
 * removed.
 */
static void flood_masks(xmlDoc *doc, const FlLeaves *leaves, int depth)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    add_flood(doc);
    FL_EACH (const FlGroupMask, mask, leaves->mask) {
        if (mask->depth != depth)
            continue;
        xmlNode *node = group_of(ids, mask);
        // the hidden content still determines the box; librsvg ignores !important for filters
        fl_declare(node, PLAIN "visibility:hidden !important;filter:url(#" FLOOD_ID ")");
        declare_outwards(fl_element_around(node),
                         PLAIN "mask:none !important;filter:none !important");
    }
}

/* ---- variants of the document ---------------------------------------------------------------- */

/** kind: 0, 1 without masks, 2 masks alone, of a depth in place of a part. */
static gpointer variant_key(int part, int kind)
{
    return GINT_TO_POINTER(3 * part + kind + 1);
}

/** Leaves out fills or strokes. */
static void keep_part(xmlDoc *doc, const FlLeaves *leaves, FlPart part)
{
    static const char *const hide[] = {NULL, "stroke", "fill"};
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    for (guint i = 0; i < leaves->leaf->len && hide[part]; i++)
        fl_declare(g_hash_table_lookup(ids, g_array_index(leaves->leaf, FlLeaf, i).id),
                   "%s:none !important", hide[part]);
}

/** Makes a handle and keeps it in svg->variants. */
static RsvgHandle *add_variant(FlSvg *svg, gpointer key, xmlDoc *doc, GError **error)
{
    size_t bytes = 0;
    g_autofree char *text = fl_document_text(doc, &bytes);
    RsvgHandle *handle = fl_svg_make_handle(svg, text, bytes, error);
    if (handle)
        g_hash_table_insert(svg->variants, key, handle);
    return handle;
}

RsvgHandle *fl_svg_handle(FlSvg *svg, FlPart part, bool bare, GError **error)
{
    if (part == FL_PART_WHOLE && !bare)
        return svg->handle;
    gpointer key = variant_key((int)part, bare);
    RsvgHandle *handle = g_hash_table_lookup(svg->variants, key);
    if (handle)
        return handle;
    g_autoptr(xmlDoc) copy = xmlCopyDoc(svg->doc, 1);
    keep_part(copy, svg->leaves, part);
    if (bare)
        drop_masks(copy, svg->leaves);
    return add_variant(svg, key, copy, error);
}

RsvgHandle *fl_svg_mask_handle(FlSvg *svg, int depth, GError **error)
{
    gpointer key = variant_key(depth, 2);
    RsvgHandle *handle = g_hash_table_lookup(svg->variants, key);
    if (handle)
        return handle;
    g_autoptr(xmlDoc) copy = xmlCopyDoc(svg->doc, 1);
    flood_masks(copy, svg->leaves, depth);
    return add_variant(svg, key, copy, error);
}
