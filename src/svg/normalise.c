#include "svg/normalise.h"

#include "base/limits.h"
#include "svg/use.h"
#include <string.h>

typedef struct Work {
    const char *path;
    int number;
    FlWarnings *warnings;
    GHashTable *ids; // id -> xmlNode, the first of that id
} Work;

bool fl_is_undrawn(const xmlNode *node)
{
    return fl_is_one_of(node, "defs symbol clipPath mask pattern marker linearGradient "
                              "radialGradient filter style script title desc metadata");
}

static void name_groups(xmlNode *node, GHashTable *ids, int *n_made)
{
    FL_EACH_ELEMENT (child, node) {
        if (fl_is_undrawn(child))
            continue;
        const char *id = fl_attribute(child, "id");
        if (!id && (fl_is_container(child) || fl_is(child, "use"))) {
            g_autofree char *made = NULL;
            do {
                g_free(made);
                made = g_strdup_printf(FL_GROUP_ID "%d", (*n_made)++);
            } while (g_hash_table_contains(ids, made));
            fl_set_attribute(child, "id", made);
            g_hash_table_insert(ids, g_steal_pointer(&made), child);
        }
        name_groups(child, ids, n_made);
    }
}

GHashTable *fl_document_name_groups(xmlDoc *doc, int *n_made)
{
    GHashTable *ids = fl_document_ids(doc);
    *n_made = 0;
    name_groups(xmlDocGetRootElement(doc), ids, n_made);
    return ids;
}

bool fl_is_whole(const xmlNode *node, const char *const *whole)
{
    if (!whole)
        return false;
    const char *id = fl_attribute(node, "id");
    return id && g_strv_contains(whole, id);
}

/** Returns: true if one of the languages is the user's; without a locale it is English. */
static bool speaks(const char *languages)
{
    static const char *const english[] = {"en", NULL};
    g_auto(GStrv) asked = g_strsplit(languages, ",", -1);
    const gchar *const *spoken = g_get_language_names();
    spoken = *spoken[0] == 'C' ? english : spoken;
    for (int i = 0; asked[i]; i++) {
        const char *language = g_strstrip(asked[i]);
        const size_t n = strcspn(language, "-_");
        for (int j = 0; spoken[j]; j++)
            if (n > 0 && g_ascii_strncasecmp(spoken[j], language, n) == 0)
                return true;
    }
    return false;
}

/** Returns: true if librsvg has all features of a list; diagrams.net asks for foreign content. */
static bool has_features(const char *features)
{
    static const char *const lacking[] = {"#Extensibility", "#Animation", "#Script", "Events",
                                          NULL};
    for (int i = 0; lacking[i]; i++)
        if (strstr(features, lacking[i]))
            return false;
    return true;
}

bool fl_is_eligible(const xmlNode *node)
{
    const char *features = fl_attribute(node, "requiredFeatures");
    if (features && !has_features(features))
        return false;
    const char *extensions = fl_attribute(node, "requiredExtensions");
    const char *languages = fl_attribute(node, "systemLanguage");
    return !extensions && (!languages || speaks(languages));
}

/** Ineligible children go into a <defs>, where references still find them. */
static void resolve_switch(xmlNode *node)
{
    bool chosen = false;
    xmlNode *defs = xmlNewDocNode(node->doc, node->ns, (const xmlChar *)"defs", NULL);
    for (xmlNode *child = node->children, *next; child; child = next) {
        next = child->next;
        if (child->type != XML_ELEMENT_NODE)
            continue;
        if (!chosen && fl_is_eligible(child)) {
            chosen = true;
        } else {
            xmlUnlinkNode(child);
            xmlAddChild(defs, child);
        }
    }
    xmlAddChild(node, defs);
    xmlNodeSetName(node, (const xmlChar *)"g");
}

/** Of <use>, those are left that refer to another file, and those that show nothing, which are
 * hidden with the elements written in them. */
static void resolve_use(const Work *work, xmlNode *use)
{
    g_autofree char *href = fl_href(use);
    const char *id = fl_attribute(use, "id");
    if (href && href[0] != '#')
        return; // librsvg draws it as one leaf
    const bool made = id && g_str_has_prefix(id, FL_GROUP_ID);
    if (href && g_hash_table_contains(work->ids, href + 1) && fl_use_is_drawn(use))
        fl_warnings_add(work->warnings, work->path, work->number, made ? NULL : id,
                        "<use> of “%s” shows itself and is left out", href);
    fl_declare(use, "display:none");
}

static bool is_shallow(const Work *work, const xmlNode *node, GError **error)
{
    int depth = 0;
    for (; node; node = node->parent)
        depth++;
    return fl_limit_check(FL_LIMIT_DEPTH, depth, work->path, error);
}

static bool normalise(const Work *work, xmlNode *node, GError **error)
{
    if (!is_shallow(work, node, error))
        return false;
    for (xmlNode *child = node->children, *next; child; child = next) {
        next = child->next;
        if (child->type != XML_ELEMENT_NODE || fl_is_undrawn(child))
            continue;
        if (fl_is(child, "switch"))
            resolve_switch(child);
        if (fl_is(child, "use"))
            resolve_use(work, child);
        else if (!normalise(work, child, error))
            return false;
    }
    return true;
}

bool fl_document_normalise(xmlDoc *doc, GHashTable *ids, const char *path, int number,
                           FlWarnings *warnings, GError **error)
{
    const Work work = {path, number, warnings, ids};
    return normalise(&work, xmlDocGetRootElement(doc), error);
}
