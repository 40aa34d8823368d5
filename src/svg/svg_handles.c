#include "svg/group_mask.h"
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
    g_set_error(error, FL_ERROR, FL_ERROR_INPUT, "%s: cannot be drawn: %s", svg->path, message);
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

/** kind: 0, 1 without masks, 2 masks alone, of a depth in place of a part. */
static gpointer variant_key(int part, int kind)
{
    return GINT_TO_POINTER(3 * part + kind + 1);
}

/** Leaves out fills or strokes. */
static void keep_part(xmlDoc *doc, const FlLeaves *leaves, FlPart part)
{
    static const char *const hide[] = {NULL, "stroke:none !important", "fill:none !important"};
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    for (guint i = 0; i < leaves->leaf->len && hide[part]; i++)
        fl_declare(g_hash_table_lookup(ids, g_array_index(leaves->leaf, FlLeaf, i).id), hide[part]);
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
        fl_group_masks_drop(copy, svg->leaves);
    return add_variant(svg, key, copy, error);
}

RsvgHandle *fl_svg_mask_handle(FlSvg *svg, int depth, GError **error)
{
    gpointer key = variant_key(depth, 2);
    RsvgHandle *handle = g_hash_table_lookup(svg->variants, key);
    if (handle)
        return handle;
    g_autoptr(xmlDoc) copy = xmlCopyDoc(svg->doc, 1);
    fl_group_masks_flood(copy, svg->leaves, depth);
    return add_variant(svg, key, copy, error);
}
