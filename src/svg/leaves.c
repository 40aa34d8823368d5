#include "svg/leaves.h"

#include "svg/document.h"
#include "svg/labels.h"
#include "svg/normalise.h"
#include "svg/use.h"
#include <string.h>

/** The lists that a leaf inherits from its groups; they grow inwards and are cut back. */
enum { LABELS, LAYERS, IDS, GROUPS, CLASSES, TREE, N_LISTS };

typedef struct Walk {
    GString *list[N_LISTS];
    const char *const *whole;
    FlLeaves *leaves;
    GHashTable *by_id; // id -> xmlNode, the first with that id
    int unit;          // outermost unit around; -1 outside units
    int mask;          // innermost group around with a mask; -1 without masks
    int n_made;        // ids made
} Walk;

static void append(GString *list, const char *item)
{
    if (!item || !item[0])
        return;
    if (list->len)
        g_string_append_c(list, '\n');
    g_string_append(list, item);
}

static const char *authored_id(const xmlNode *node)
{
    static const char *const names[] = {"id", FL_COPIED_ID};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++) {
        const char *id = fl_attribute(node, names[i]);
        if (id && !g_str_has_prefix(id, FL_GROUP_ID))
            return id;
    }
    return NULL;
}

static void append_group(Walk *w, const xmlNode *node)
{
    const char *id = fl_attribute(node, "id");
    if (id && fl_is_container(node) && g_hash_table_lookup(w->by_id, id) == node)
        append(w->list[GROUPS], id);
}

static void enter(Walk *w, const xmlNode *node, int index)
{
    const char *id = authored_id(node);
    const char *classes = fl_attribute(node, "class");
    bool is_layer = false;
    g_autofree char *label = fl_label_of(node, id, &is_layer);
    append(w->list[LABELS], label);
    if (label && (is_layer || w->list[LAYERS]->len == 0))
        append(w->list[LAYERS], label);
    append(w->list[IDS], id);
    append_group(w, node);
    g_auto(GStrv) words = g_strsplit_set(classes ? classes : "", " \t\r\n", -1);
    for (int i = 0; words[i]; i++)
        append(w->list[CLASSES], words[i]);
    g_string_append_printf(w->list[TREE], w->list[TREE]->len ? "/%d" : "%d", index);
}

/** A copy of a text, which belongs to the leaves. */
static char *keep(const Walk *w, const char *text)
{
    return g_string_chunk_insert_const(w->leaves->text, text);
}

/** The node's id if it is the first of that id, else a new one, which goes into the document. */
static char *give_id(Walk *w, xmlNode *node)
{
    const char *id = fl_attribute(node, "id");
    if (id && id[0] && g_hash_table_lookup(w->by_id, id) == node)
        return keep(w, id);
    g_autofree char *made = NULL;
    do {
        g_free(made);
        made = g_strdup_printf("fl-leaf-%d", w->n_made++);
    } while (g_hash_table_contains(w->by_id, made));
    fl_set_attribute(node, "id", made);
    char *kept = keep(w, made);
    g_hash_table_insert(w->by_id, g_steal_pointer(&made), node);
    return kept;
}

static bool has_text(const xmlNode *node)
{
    bool found = fl_is(node, "text");
    for (const xmlNode *child = node->children; child && !found; child = child->next)
        found = child->type == XML_ELEMENT_NODE && has_text(child);
    return found;
}

static bool is_listed(const Walk *w, const char *key)
{
    return w->whole && g_strv_contains(w->whole, key);
}

char *fl_leaf_key(const FlLeaf *leaf)
{
    return leaf->name[0] && strcmp(leaf->id, leaf->name) == 0
               ? g_strdup(leaf->id)
               : g_strconcat(FL_SHAPE_AT, leaf->tree, NULL);
}

/** The id of the outermost group around with a mask; NULL without masks. */
static const char *outermost_mask(const Walk *w)
{
    const FlGroupMask *mask = NULL;
    for (int i = w->mask; i >= 0; i = mask->around)
        mask = &g_array_index(w->leaves->mask, FlGroupMask, i);
    return mask ? mask->group : NULL;
}

static FlLeaf make_leaf(Walk *w, xmlNode *node)
{
    const char *authored = authored_id(node);
    char *name = keep(w, authored ? authored : ""); // an id may be replaced
    static const char *const markers[] = {"marker", "marker-start", "marker-mid", "marker-end",
                                          NULL};
    bool whole = fl_is_one_of(node, "text image use g svg a");
    for (int i = 0; markers[i] && !whole; i++) {
        g_autofree char *marker = fl_property(node, markers[i]);
        whole = marker && strcmp(marker, "none") != 0;
    }
    char *id = give_id(w, node);
    const char *masked = outermost_mask(w);
    FlLeaf leaf = {
        .id = id,
        .layer = keep(w, masked ? masked : id),
        .mask = w->mask,
        .name = name,
        .labels = keep(w, w->list[LABELS]->str),
        .layers = keep(w, w->list[LAYERS]->str),
        .ids = keep(w, w->list[IDS]->str),
        .groups = keep(w, w->list[GROUPS]->str),
        .classes = keep(w, w->list[CLASSES]->str),
        .tree = keep(w, w->list[TREE]->str),
        .unit = w->unit,
        .text = has_text(node),
    };
    g_autofree char *key = fl_leaf_key(&leaf);
    leaf.whole = whole || is_listed(w, key);
    return leaf;
}

static bool is_hidden(const xmlNode *node)
{
    g_autofree char *display = fl_property(node, "display");
    return display && g_str_has_prefix(display, "none");
}

static bool is_drawn(const xmlNode *node)
{
    return fl_is_one_of(node, "path rect circle ellipse line polyline polygon text image use");
}

/** Returns: true if a group is drawn as one even where its shapes do not overlap. */
static bool is_inseparable(const xmlNode *node)
{
    return fl_is_set(node, "filter") || fl_is_set(node, "mix-blend-mode");
}

/** Returns: true if an element in a node blends with the backdrop. */
static bool has_blend(const xmlNode *node)
{
    bool found = false;
    for (const xmlNode *child = node->children; child && !found; child = child->next)
        found = child->type == XML_ELEMENT_NODE &&
                (fl_is_set(child, "mix-blend-mode") || has_blend(child));
    return found;
}

static void walk(Walk *w, xmlNode *node);

static void walk_masked(Walk *w, xmlNode *node)
{
    FlLeaves *leaves = w->leaves;
    const int around = w->mask;
    const guint first = leaves->leaf->len, first_mask = leaves->mask->len;
    const FlGroupMask mask = {
        give_id(w, node), around,
        around < 0 ? 0 : 1 + g_array_index(leaves->mask, FlGroupMask, around).depth};
    w->mask = (int)first_mask;
    g_array_append_val(leaves->mask, mask);
    walk(w, node);
    w->mask = around;
    if (around >= 0 || leaves->leaf->len - first > 1)
        return;
    g_array_set_size(leaves->mask, first_mask);
    if (leaves->leaf->len > first)
        g_array_index(leaves->leaf, FlLeaf, first).mask = -1;
}

static void walk_group(Walk *w, xmlNode *node)
{
    if (fl_is_set(node, "mask"))
        walk_masked(w, node);
    else
        walk(w, node);
}

/**
 * Walks a group that may have to be drawn as one; it is a unit if it has two leaves or more, or one
 * that would blend with what is below the group.
 */
static void walk_unit(Walk *w, xmlNode *node)
{
    FlLeaves *leaves = w->leaves;
    const int first = (int)leaves->leaf->len;
    w->unit = (int)leaves->unit->len;
    walk_group(w, node);
    w->unit = -1;
    const int n = (int)leaves->leaf->len - first;
    const bool blends = n > 0 && has_blend(node);
    if (n < 2 && !blends) {
        for (int i = 0; i < n; i++)
            g_array_index(leaves->leaf, FlLeaf, first + i).unit = -1;
        return;
    }
    const bool isolated = blends && !fl_changes_as_one(node);
    const FlGroupUnit unit = {make_leaf(w, node), first, n,
                              (blends && !isolated) || is_inseparable(node), isolated};
    g_array_append_val(leaves->unit, unit);
}

static void walk(Walk *w, xmlNode *node)
{
    int index = -1;
    FL_EACH_ELEMENT (child, node) {
        index++;
        if (fl_is_undrawn(child) || is_hidden(child))
            continue;
        gsize before[N_LISTS];
        for (int k = 0; k < N_LISTS; k++)
            before[k] = w->list[k]->len;
        enter(w, child, index);
        if (is_drawn(child) || fl_is_whole(child, w->whole)) {
            const FlLeaf leaf = make_leaf(w, child);
            g_array_append_val(w->leaves->leaf, leaf);
        } else if (fl_is_container(child) && w->unit < 0 && fl_has_effects(child)) {
            walk_unit(w, child);
        } else if (fl_is_container(child)) {
            walk_group(w, child);
        }
        for (int k = 0; k < N_LISTS; k++)
            g_string_truncate(w->list[k], before[k]);
    }
}

/** Makes the whole document one leaf. */
static void add_all(Walk *w, xmlNode *root)
{
    FlLeaf leaf = make_leaf(w, root);
    leaf.all = leaf.whole = true;
    g_array_append_val(w->leaves->leaf, leaf);
}

FlLeaves *fl_leaves_new(xmlDoc *doc, const char *const *whole, GHashTable *ids)
{
    FlLeaves *leaves = g_new0(FlLeaves, 1);
    leaves->leaf = g_array_new(FALSE, FALSE, sizeof(FlLeaf));
    leaves->unit = g_array_new(FALSE, FALSE, sizeof(FlGroupUnit));
    leaves->mask = g_array_new(FALSE, FALSE, sizeof(FlGroupMask));
    leaves->text = g_string_chunk_new(4096);
    Walk w = {.whole = whole, .leaves = leaves, .unit = -1, .mask = -1};
    for (int k = 0; k < N_LISTS; k++)
        w.list[k] = g_string_new(NULL);
    w.by_id = leaves->ids = ids;
    if (whole && g_strv_contains(whole, FL_WHOLE_ALL))
        add_all(&w, xmlDocGetRootElement(doc));
    else
        walk(&w, xmlDocGetRootElement(doc));
    for (int k = 0; k < N_LISTS; k++)
        g_string_free(w.list[k], TRUE);
    return leaves;
}

void fl_leaves_free(FlLeaves *leaves)
{
    if (!leaves)
        return;
    g_array_unref(leaves->leaf);
    g_array_unref(leaves->unit);
    g_array_unref(leaves->mask);
    g_string_chunk_free(leaves->text);
    g_hash_table_unref(leaves->ids);
    g_free(leaves);
}
