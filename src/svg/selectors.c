#include "svg/selectors.h"

#include <string.h>

static bool is_part_of_name(char c)
{
    return g_ascii_isalnum(c) || strchr("-_", c);
}

/** Of a list of selectors, n bytes. */
static FlSelectors in_list(const char *text, size_t n)
{
    FlSelectors found = FL_SELECTORS_PLAIN;
    for (size_t i = 0; i < n; i++) {
        const bool begins =
            text[i] == 'g' &&
            (i == 0 || !(is_part_of_name(text[i - 1]) || strchr(".#", text[i - 1])));
        if (strchr(">+~:*[@&", text[i]) ||
            (begins && (i + 1 == n || !is_part_of_name(text[i + 1]))))
            found |= FL_SELECTORS_PLACES;
        else if (text[i] == '#')
            found |= FL_SELECTORS_IDS;
    }
    return found;
}

static FlSelectors in_sheet(const char *text)
{
    FlSelectors found = FL_SELECTORS_PLAIN;
    while (*text) {
        const size_t n = strcspn(text, "{");
        found |= in_list(text, n);
        text += n;
        text += strcspn(text, "}");
        text += *text == '}';
    }
    return found;
}

/** In the sheets from a node on. */
static FlSelectors in_nodes(const xmlNode *node)
{
    FlSelectors found = FL_SELECTORS_PLAIN;
    for (; node; node = node->next)
        if (node->type == XML_PI_NODE) {
            found |= FL_SELECTORS_PLACES; // perhaps a sheet
        } else if (fl_is(node, "style")) {
            g_autoptr(xmlChar) text = xmlNodeGetContent(node);
            found |= text ? in_sheet((const char *)text) : FL_SELECTORS_PLAIN;
        } else if (node->type == XML_ELEMENT_NODE) {
            found |= in_nodes(node->children);
        }
    return found;
}

FlSelectors fl_document_selectors(const xmlDoc *doc)
{
    return in_nodes(doc->children);
}
