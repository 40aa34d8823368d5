#include "svg/use.h"

#include "base/limits.h"
#include "svg/transform.h"

typedef struct Uses {
    xmlDoc *doc;
    const char *path;
    GHashTable *ids;    // id -> xmlNode, the first of that id
    GHashTable *copies; // <use> -> the copy in it
    int n_elements;     // that were copied
    double bytes;       // of their text and attributes
} Uses;

/** The elements that the <use> around show, the innermost first. */
typedef struct Shown {
    const struct Shown *around;
    const xmlNode *node;
} Shown;

static bool is_zero(const xmlNode *node, const char *name)
{
    const char *length = fl_attribute(node, name);
    return length && g_ascii_strtod(length, NULL) == 0;
}

bool fl_use_is_drawn(const xmlNode *use)
{
    return !is_zero(use, "width") && !is_zero(use, "height");
}

/* ---- copying --------------------------------------------------------------------------------- */

static double bytes_of(const xmlNode *text)
{
    double bytes = 0;
    for (; text; text = text->next)
        bytes += text->type == XML_ELEMENT_NODE ? 0 : xmlStrlen(text->content);
    return bytes;
}

/** Points the elements of a copy to those that were written, puts their ids aside, which stay
 * unique, and counts them. */
static void link_copy(Uses *uses, xmlNode *copy, const xmlNode *from)
{
    const char *id = fl_attribute(copy, "id");
    copy->_private = from->_private ? from->_private : (xmlNode *)from;
    if (id) {
        fl_set_attribute(copy, FL_COPIED_ID, id);
        fl_set_attribute(copy, "id", NULL);
    }
    uses->n_elements++;
    uses->bytes += bytes_of(copy->children);
    for (const xmlAttr *a = copy->properties; a; a = a->next)
        uses->bytes += bytes_of(a->children);
    const xmlNode *child = xmlFirstElementChild((xmlNode *)from);
    FL_EACH_ELEMENT (to, copy) {
        link_copy(uses, to, child);
        child = xmlNextElementSibling((xmlNode *)child);
    }
}

/** The element that a <use> shows; NULL: it is in another file, missing, hidden, or shows itself.
 */
static const xmlNode *target_of(const Uses *uses, const xmlNode *use, const Shown *around,
                                int depth)
{
    g_autofree char *href = fl_use_is_drawn(use) ? fl_href(use) : NULL;
    const xmlNode *target = href && *href == '#' ? g_hash_table_lookup(uses->ids, href + 1) : NULL;
    for (const Shown *s = around; s && target; s = s->around)
        target = s->node == target ? NULL : target;
    for (const xmlNode *at = use; at && target; at = at->parent)
        target = at == target ? NULL : target;
    return depth > fl_limit(FL_LIMIT_DEPTH) ? NULL : target;
}

/** The copy of what it shows in a <use> that was copied with it; NULL: it has none yet. */
static xmlNode *copy_in(xmlNode *use, const xmlNode *target)
{
    xmlNode *copy = xmlLastElementChild(use);
    return copy && copy->_private == target ? copy : NULL;
}

static bool copy_shown(Uses *uses, xmlNode *use, const xmlNode *target, GError **error)
{
    xmlNode *copy = copy_in(use, target);
    if (!copy) {
        copy = xmlAddChild(use, xmlDocCopyNode((xmlNode *)target, uses->doc, 1));
        link_copy(uses, copy, target);
    }
    g_hash_table_insert(uses->copies, use, copy);
    return fl_limit_check(FL_LIMIT_ELEMENTS, uses->n_elements, uses->path, error) &&
           fl_limit_check(FL_LIMIT_DRAWING, uses->bytes / (1 << 20), uses->path, error);
}

static bool visit(Uses *uses, xmlNode *node, const Shown *around, int depth, GError **error)
{
    FL_EACH_ELEMENT (child, node) {
        const xmlNode *target = fl_is(child, "use") ? target_of(uses, child, around, depth) : NULL;
        const Shown inner = {around, target};
        if (target && !copy_shown(uses, child, target, error))
            return false;
        if (!fl_is(child, "clipPath") &&
            !visit(uses, child, target ? &inner : around, depth + 1, error))
            return false;
    }
    return true;
}

GHashTable *fl_uses_copy(xmlDoc *doc, const char *path, GError **error)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc), copies = g_hash_table_new(NULL, NULL);
    Uses uses = {.doc = doc, .path = path, .ids = ids, .copies = copies};
    return visit(&uses, xmlDocGetRootElement(doc), NULL, 0, error) ? g_steal_pointer(&copies)
                                                                   : NULL;
}

/* ---- showing --------------------------------------------------------------------------------- */

/** Removes an attribute. Returns: its value, to be freed, or NULL. */
static char *take(xmlNode *node, const char *name)
{
    char *value = g_strdup(fl_attribute(node, name));
    fl_set_attribute(node, name, NULL);
    return value;
}

/** The size that <use> gives, if any, or that of the symbol itself. */
static void give_size(xmlNode *copy, const char *name, const char *size, bool symbol)
{
    if (size || (symbol && !fl_attribute(copy, name)))
        fl_set_attribute(copy, name, size ? size : "100%");
}

void fl_use_give_size(xmlNode *use, xmlNode *copy)
{
    g_autofree char *width = take(use, "width"), *height = take(use, "height");
    const bool symbol = fl_is(copy, "symbol");
    g_autofree char *overflow = symbol ? fl_property(copy, "overflow") : NULL;
    if (symbol)
        xmlNodeSetName(copy, (const xmlChar *)"svg");
    if (symbol && !overflow)
        fl_set_attribute(copy, "overflow", "hidden"); // a browser's own style sheet says so
    if (symbol || fl_is(copy, "svg")) {
        give_size(copy, "width", width, symbol);
        give_size(copy, "height", height, symbol);
    }
}

void fl_use_place(xmlNode *use, const FlCssUnits *units)
{
    const double x = fl_length_of(use, "x", units, units->width);
    const double y = fl_length_of(use, "y", units, units->height);
    fl_set_attribute(use, "x", NULL);
    fl_set_attribute(use, "y", NULL);
    if (x != 0 || y != 0)
        fl_set_affine(use, "transform",
                      fl_affine_multiply(fl_affine_of(use), fl_affine_move(x, y)));
}

void fl_uses_make_groups(GHashTable *copies)
{
    GHashTableIter iter;
    gpointer use, copy;
    g_hash_table_iter_init(&iter, copies);
    while (g_hash_table_iter_next(&iter, &use, &copy)) {
        FL_EACH_ELEMENT (child, use)
            if (child != copy)
                fl_declare(child, "display:none");
        xmlNodeSetName(use, (const xmlChar *)"g");
    }
}
