#include "svg/leaf_digest.h"

#include "svg/normalise.h"
#include <string.h>

/** The elements that an element refers to, beside itself. */
typedef enum Reach {
    REACH_NONE,
    REACH_DEFINITIONS, // elements that are drawn only by reference, and files
    REACH_ALL,         // anything in the document
} Reach;

/** MAX() would digest its arguments twice. */
static Reach farther(Reach a, Reach b)
{
    return MAX(a, b);
}

typedef struct Work {
    GHashTable *place;    // id -> Place
    FlDigest definitions; // of REACH_DEFINITIONS
    FlDigest all;         // of REACH_ALL
    bool unknown;         // the document has something that is not looked at
    xmlDoc *doc;
    GHashTable *ids; // of the document, made when first needed
} Work;

/** The digests that an element is added to. */
typedef struct Place {
    FlDigest *digest;
    const FlLeaf *leaf;
} Place;

/** Returns: true if the element with this id is drawn only by reference. */
static bool is_definition(Work *work, const char *id)
{
    if (!work->ids)
        work->ids = fl_document_ids(work->doc);
    const xmlNode *node = g_hash_table_lookup(work->ids, id);
    while (node && !fl_is_undrawn(node))
        node = node->parent;
    return node != NULL;
}

/** The kind of elements that an attribute refers to. */
static Reach reach_of(Work *work, const xmlNode *node, const xmlAttr *attribute, const char *value)
{
    static const char *const definitions[] = {"linearGradient", "radialGradient", "pattern",
                                              "filter", NULL};
    if (xmlStrEqual(attribute->name, (const xmlChar *)"href") && !g_str_has_prefix(value, "data:"))
        return value[0] != '#' || fl_is_one_of(node, definitions) || is_definition(work, value + 1)
                   ? REACH_DEFINITIONS
                   : REACH_ALL;
    return strstr(value, "url(") ? REACH_DEFINITIONS : REACH_NONE;
}

/** The only text of an attribute; an entity in it is not looked at. */
static const char *value_of(Work *work, const xmlAttr *attribute)
{
    const xmlNode *text = attribute->children;
    if (!text)
        return "";
    work->unknown |= text->type != XML_TEXT_NODE || text->next;
    return text->content ? (const char *)text->content : "";
}

static bool is_made_id(const xmlAttr *attribute, const char *value)
{
    return xmlStrEqual(attribute->name, (const xmlChar *)"id") && g_str_has_prefix(value, "fl-");
}

/** Adds an element's name and attributes. Generated ids are left out, since they depend on the
 * elements before. */
static Reach add_element(Work *work, const xmlNode *node, FlDigest *digest)
{
    Reach reach = REACH_NONE;
    fl_digest_add_text(digest, (const char *)node->name);
    for (const xmlAttr *a = node->properties; a; a = a->next) {
        const char *value = value_of(work, a);
        if (is_made_id(a, value))
            continue;
        fl_digest_add_text(digest, (const char *)a->name);
        fl_digest_add_text(digest, value);
        reach = farther(reach, reach_of(work, node, a, value));
    }
    return reach;
}

/** Adds an element and all its descendants. */
static Reach add_tree(Work *work, const xmlNode *node, FlDigest *digest)
{
    Reach reach = add_element(work, node, digest);
    for (const xmlNode *child = node->children; child; child = child->next) {
        if (child->type == XML_ELEMENT_NODE)
            reach = farther(reach, add_tree(work, child, digest));
        else if (child->type == XML_TEXT_NODE || child->type == XML_CDATA_SECTION_NODE)
            fl_digest_add_text(digest, (const char *)child->content);
        work->unknown |= child->type == XML_ENTITY_REF_NODE;
    }
    fl_digest_add_text(digest, NULL);
    return reach;
}

/** Adds the attributes that an element may inherit from its parent. */
static void add_inherited(Work *work, const xmlNode *around, FlDigest *digest)
{
    for (const xmlAttr *a = around->properties; a; a = a->next) {
        const char *value = value_of(work, a);
        if (is_made_id(a, value) || xmlStrEqual(a->name, (const xmlChar *)"transform"))
            continue;
        fl_digest_add_text(digest, (const char *)a->name);
        fl_digest_add_text(digest, value);
    }
}

/** Adds something that is drawn only when it is referred to, with what it inherits. */
static void add_definition(Work *work, const xmlNode *node)
{
    static const char *const words[] = {"title", "desc", "metadata", NULL};
    if (fl_is_one_of(node, words))
        return; // librsvg does not draw them
    for (const xmlNode *around = node->parent; around->type == XML_ELEMENT_NODE;
         around = around->parent)
        add_inherited(work, around, &work->definitions);
    if (add_tree(work, node, &work->definitions) == REACH_ALL)
        work->definitions = work->all;
}

/** Digests what is drawn only when it is referred to. */
static void digest_definitions(Work *work, const xmlNode *node)
{
    for (const xmlNode *child = node->children; child; child = child->next) {
        if (child->type != XML_ELEMENT_NODE)
            continue;
        if (fl_is_undrawn(child))
            add_definition(work, child);
        digest_definitions(work, child);
    }
}

static void add_reached(const Work *work, Reach reach, FlDigest *digest)
{
    const FlDigest *reached = reach == REACH_ALL ? &work->all : &work->definitions;
    if (reach > REACH_NONE)
        fl_digest_add(digest, reached, sizeof *reached);
}

static void put_leaf(Work *work, const xmlNode *node, const Place *place, FlDigest around,
                     Reach reach)
{
    const FlLeaf *leaf = place->leaf;
    const uint8_t how[] = {leaf->whole, leaf->text, leaf->all, leaf->mask >= 0};
    FlDigest digest = around;
    reach = farther(reach, add_tree(work, node, &digest));
    add_reached(work, reach, &digest);
    fl_digest_add(&digest, how, sizeof how);
    *place->digest = digest;
}

/** around: the digest of the ancestors. A group's reference may depend on its box, which all of its
 * content determines. */
static void walk(Work *work, const xmlNode *node, FlDigest around, Reach reach)
{
    for (const xmlNode *child = node->children; child; child = child->next) {
        work->unknown |= child->type == XML_ENTITY_REF_NODE;
        if (child->type != XML_ELEMENT_NODE || fl_is_undrawn(child))
            continue;
        g_autoptr(xmlChar) id = fl_attribute(child, "id");
        const Place *place = id ? g_hash_table_lookup(work->place, id) : NULL;
        if (place)
            put_leaf(work, child, place, around, reach);
        FlDigest own = around;
        const bool says = child->properties && (child->properties->next || !id); // more than an id
        const Reach of_own = says ? add_element(work, child, &own) : REACH_NONE;
        if (of_own > REACH_NONE || reach > REACH_NONE)
            add_tree(work, child, &own);
        walk(work, child, own, farther(reach, of_own));
    }
}

static void list_places(Work *work, const GArray *leaves, size_t bytes, FlDigest *digest)
{
    for (guint i = 0; i < leaves->len; i++) {
        const FlLeaf *leaf = (const FlLeaf *)(const void *)(leaves->data + i * bytes);
        Place *place = g_new(Place, 1);
        *place = (Place){&digest[i], leaf};
        digest[i] = (FlDigest){0, 0};
        g_hash_table_insert(work->place, leaf->id, place);
    }
}

/** Adds the files that anything refers to. */
static void add_files(Work *work, const FlSvg *svg)
{
    const GPtrArray *files = fl_svg_files(svg);
    for (guint i = 0; i < files->len; i++)
        fl_digest_add_text(&work->definitions, g_ptr_array_index(files, i));
    work->all = work->definitions;
}

void fl_leaf_digests(FlSvg *svg, FlDigest *leaf, FlDigest *unit)
{
    const FlLeaves *leaves = fl_svg_leaves(svg);
    xmlDoc *doc = fl_svg_document(svg);
    const xmlNode *root = xmlDocGetRootElement(doc);
    Work work = {.place = g_hash_table_new_full(g_str_hash, g_str_equal, NULL, g_free), .doc = doc};
    FlDigest around = {0, 0};
    list_places(&work, leaves->leaf, sizeof(FlLeaf), leaf);
    G_STATIC_ASSERT(offsetof(FlGroupUnit, leaf) == 0);
    list_places(&work, leaves->unit, sizeof(FlGroupUnit), unit);
    add_files(&work, svg);
    add_tree(&work, root, &work.all);
    digest_definitions(&work, root);
    const Reach reach = add_element(&work, root, &around);
    walk(&work, root, around, reach);
    if (work.unknown) {
        memset(leaf, 0, leaves->leaf->len * sizeof *leaf);
        memset(unit, 0, leaves->unit->len * sizeof *unit);
    }
    g_hash_table_unref(work.place);
    g_clear_pointer(&work.ids, g_hash_table_unref);
}
