#include "svg/css.h"

#include <string.h>

struct FlCss {
    GHashTable *bits; // ".class", "#id" or "name" -> FlCssBits
};

static unsigned bits_of(const char *declarations)
{
    static const struct {
        const char *property;
        unsigned bit;
    } known[] = {{"opacity", FL_CSS_OPACITY},
                 {"mask", FL_CSS_MASK},
                 {"filter", FL_CSS_FILTER},
                 {"mix-blend-mode", FL_CSS_BLEND}};
    unsigned bits = 0;
    g_auto(GStrv) list = g_strsplit(declarations, ";", -1);
    for (int i = 0; list[i]; i++) {
        char *colon = strchr(list[i], ':');
        if (!colon)
            continue;
        *colon = '\0';
        for (size_t k = 0; k < G_N_ELEMENTS(known); k++)
            if (g_ascii_strcasecmp(g_strstrip(list[i]), known[k].property) == 0)
                bits |= known[k].bit;
    }
    return bits;
}

static void add(FlCss *css, char *name, unsigned bits)
{
    bits |= GPOINTER_TO_UINT(g_hash_table_lookup(css->bits, name));
    g_hash_table_replace(css->bits, name, GUINT_TO_POINTER(bits));
}

/** Adds the simple selectors of the last compound: "g .a.b:hover" has ".a" and ".b". */
static void add_selector(FlCss *css, const char *selector, unsigned bits)
{
    const char *last = selector + strlen(selector);
    while (last > selector && !strchr(" >+~", last[-1]))
        last--;
    while (*last) {
        const size_t n = 1 + strcspn(last + 1, ".#:[");
        if (strchr(".#", *last) || g_ascii_isalpha(*last))
            add(css, g_strndup(last, n), bits);
        last += n;
    }
}

static void add_rules(FlCss *css, const char *text)
{
    g_autoptr(GRegex) comment = g_regex_new("/\\*.*?\\*/", G_REGEX_DOTALL, 0, NULL);
    g_autofree char *bare = g_regex_replace_literal(comment, text, -1, 0, " ", 0, NULL);
    g_auto(GStrv) rules = g_strsplit(bare ? bare : "", "}", -1);
    for (int i = 0; rules[i]; i++) {
        char *brace = strrchr(rules[i], '{'); // of "@media … {.a{mask:…" the inner one
        const unsigned bits = brace ? bits_of(brace + 1) : 0;
        if (!bits)
            continue;
        *brace = '\0';
        char *outer = strrchr(rules[i], '{');
        g_auto(GStrv) selectors = g_strsplit(outer ? outer + 1 : rules[i], ",", -1);
        for (int k = 0; selectors[k]; k++)
            add_selector(css, g_strstrip(selectors[k]), bits);
    }
}

static void collect(FlCss *css, xmlNode *node)
{
    if (fl_is(node, "style")) {
        g_autoptr(xmlChar) text = xmlNodeGetContent(node);
        if (text)
            add_rules(css, (const char *)text);
    }
    for (xmlNode *child = node->children; child; child = child->next)
        if (child->type == XML_ELEMENT_NODE)
            collect(css, child);
}

FlCss *fl_css_new(xmlDoc *doc)
{
    FlCss *css = g_new0(FlCss, 1);
    css->bits = g_hash_table_new_full(g_str_hash, g_str_equal, g_free, NULL);
    collect(css, xmlDocGetRootElement(doc));
    return css;
}

void fl_css_free(FlCss *css)
{
    if (!css)
        return;
    g_hash_table_unref(css->bits);
    g_free(css);
}

static unsigned look_up(const FlCss *css, const char *sigil, const char *name)
{
    g_autofree char *key = g_strconcat(sigil, name, NULL);
    return GPOINTER_TO_UINT(g_hash_table_lookup(css->bits, key));
}

unsigned fl_css_look_up(const FlCss *css, const xmlNode *node)
{
    if (g_hash_table_size(css->bits) == 0)
        return 0;
    g_autoptr(xmlChar) id = fl_attribute(node, "id");
    g_autoptr(xmlChar) classes = fl_attribute(node, "class");
    unsigned bits = look_up(css, "", (const char *)node->name);
    if (id)
        bits |= look_up(css, "#", (const char *)id);
    g_auto(GStrv) words = g_strsplit_set(classes ? (const char *)classes : "", " \t\r\n", -1);
    for (int i = 0; words[i]; i++)
        if (words[i][0])
            bits |= look_up(css, ".", words[i]);
    return bits;
}
