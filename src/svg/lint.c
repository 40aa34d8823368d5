#include "svg/lint.h"

#include "svg/path_data.h"
#include <string.h>

typedef struct Lint {
    const char *path;
    int number;
    FlWarnings *warnings;
    GHashTable *ids;
} Lint;

static void warn(const Lint *lint, const xmlNode *node, const char *text)
{
    g_autoptr(xmlChar) id = fl_attribute(node, "id");
    fl_warnings_add(lint->warnings, lint->path, lint->number, (const char *)id, "%s", text);
}

/** A copy of `text` without page addresses in references, NULL if it has none. */
static char *mend(const Lint *lint, const char *text)
{
    GString *out = g_string_new(NULL);
    bool mended = false;
    for (const char *s = text, *url; *s; s = url) {
        url = strstr(s, "url(");
        if (!url) {
            g_string_append(out, s);
            break;
        }
        url += 4;
        g_string_append_len(out, s, url - s);
        const size_t n = strcspn(url, ")");
        const char *hash = memchr(url, '#', n);
        g_autofree char *id = hash ? g_strndup(hash + 1, n - (size_t)(hash + 1 - url)) : NULL;
        if (id)
            g_strdelimit(id, "\"'", '\0');
        if (hash && hash != url + strspn(url, " \"'") && g_hash_table_contains(lint->ids, id)) {
            g_string_append_printf(out, "#%s", id);
            url += n;
            mended = true;
        }
    }
    return g_string_free(out, !mended);
}

/** Warns if `value` refers to an id that is not in the document. */
static void check_target(const Lint *lint, const xmlNode *node, const char *name, const char *value)
{
    const char *hash = strstr(value, "url(");
    if (!hash)
        return;
    hash += 4 + strspn(hash + 4, " \"'");
    const size_t n = strcspn(hash, ")\"' ");
    g_autofree char *id = n > 0 ? g_strndup(hash + 1, n - 1) : NULL;
    if (id && hash[0] == '#' && g_hash_table_contains(lint->ids, id))
        return;
    const bool paint = strcmp(name, "fill") == 0 || strcmp(name, "stroke") == 0;
    const bool fallback = paint && strchr(hash, ')') && strchr(hash, ')')[1];
    g_autofree char *text = g_strdup_printf("%s refers to “%.*s”, which is not in the file: %s",
                                            name, (int)strcspn(hash, ")"), hash,
                                            fallback ? "the colour after it is drawn"
                                            : paint  ? "nothing is drawn"
                                                     : "drawn without it");
    warn(lint, node, text);
}

static void check_references(const Lint *lint, xmlNode *node)
{
    static const char *const names[] = {"clip-path", "mask", "filter", "fill", "stroke", NULL};
    for (xmlAttr *a = node->properties; a; a = a->next) {
        g_autoptr(xmlChar) value = xmlNodeListGetString(node->doc, a->children, 1);
        g_autofree char *mended =
            value && strstr((const char *)value, "url(") ? mend(lint, (const char *)value) : NULL;
        if (mended)
            xmlSetNsProp(node, a->ns, a->name, (const xmlChar *)mended);
    }
    for (int i = 0; names[i]; i++) {
        g_autofree char *value = fl_property(node, names[i]);
        if (value)
            check_target(lint, node, names[i], value);
    }
}

static void check_sheet(const Lint *lint, const xmlNode *node, const char *css)
{
    static const struct {
        const char *trap, *text;
    } traps[] = {
        {"var(", "var() is not known: black is drawn"},
        {"@keyframes", "the CSS animation is not played: the frame's own values are drawn"},
        {"@media", "@media rules are left out"},
        {"transform-origin", "transform-origin is not known: transforms turn round the origin"},
    };
    for (size_t i = 0; i < G_N_ELEMENTS(traps); i++)
        if (strstr(css, traps[i].trap))
            warn(lint, node, traps[i].text);
}

static void check_path(const Lint *lint, const xmlNode *node)
{
    g_autoptr(xmlChar) d = fl_attribute(node, "d");
    const char *rest = d ? fl_path_data_error((const char *)d) : NULL;
    if (!rest)
        return;
    g_autofree char *text = g_strdup_printf("the path is broken at “%.12s” (character %d) and is "
                                            "drawn up to there",
                                            rest, (int)(rest - (const char *)d) + 1);
    warn(lint, node, text);
}

static void lint_node(const Lint *lint, xmlNode *node)
{
    check_references(lint, node);
    g_autoptr(xmlChar) style = fl_attribute(node, "style");
    if (style)
        check_sheet(lint, node, (const char *)style);
    if (fl_is_animation(node))
        warn(lint, node->parent, "the animation in it is not played: the base value is drawn");
    if (lint->warnings && fl_is(node, "path"))
        check_path(lint, node);
    if (fl_is(node, "style")) {
        g_autoptr(xmlChar) css = xmlNodeGetContent(node);
        check_sheet(lint, node, css ? (const char *)css : "");
    }
    for (xmlNode *child = node->children; child; child = child->next)
        if (child->type == XML_ELEMENT_NODE)
            lint_node(lint, child);
}

void fl_lint(xmlDoc *doc, const char *path, int number, FlWarnings *warnings)
{
    g_autoptr(GHashTable) ids = fl_document_ids(doc);
    const Lint lint = {path, number, warnings, ids};
    lint_node(&lint, xmlDocGetRootElement(doc));
}
