#include "svg/branch.h"

#include "svg/normalise.h"
#include <string.h>

#define FEW 24 // children that a group may have; 12 to 48 take the same time with 8000 shapes

/** Whether a list of selectors names classes, ids and elements other than <g>, and no more. */
static bool are_plain_selectors(const char *text, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        if (strchr(">+~:*[@&", text[i]))
            return false;
        const bool begins =
            g_ascii_isalpha(text[i]) &&
            (i == 0 || !(g_ascii_isalnum(text[i - 1]) || strchr("-_.#", text[i - 1])));
        if (begins && text[i] == 'g' &&
            (i + 1 == n || !(g_ascii_isalnum(text[i + 1]) || strchr("-_", text[i + 1]))))
            return false;
    }
    return true;
}

static bool is_plain_sheet(const char *text)
{
    while (*text) {
        const size_t n = strcspn(text, "{");
        if (!are_plain_selectors(text, n))
            return false;
        text += n;
        text += strcspn(text, "}");
        text += *text == '}';
    }
    return true;
}

static bool is_plain(xmlNode *node)
{
    if (node->type == XML_PI_NODE)
        return false; // perhaps a style sheet
    if (fl_is(node, "style")) {
        g_autoptr(xmlChar) text = xmlNodeGetContent(node);
        return !text || is_plain_sheet((const char *)text);
    }
    for (xmlNode *child = node->children; child; child = child->next)
        if ((child->type == XML_ELEMENT_NODE || child->type == XML_PI_NODE) && !is_plain(child))
            return false;
    return true;
}

/** Puts the node's children into groups of a few. Returns: how many groups it has then. */
static int group_children(xmlNode *node)
{
    int n = 0;
    xmlNode *child = node->children;
    node->children = node->last = NULL;
    while (child) {
        xmlNode *group = xmlNewChild(node, node->ns, (const xmlChar *)"g", NULL);
        n++;
        for (int i = 0; i < FEW && child; i++) {
            xmlNode *next = child->next;
            child->parent = group;
            child->prev = group->last;
            child->next = NULL;
            *(group->last ? &group->last->next : &group->children) = child;
            group->last = child;
            child = next;
        }
    }
    return n;
}

/** Drops the white space between elements: librsvg visits it too. Returns: the children left. */
static int drop_spaces(xmlNode *node)
{
    int n = 0;
    for (xmlNode *child = node->children, *next; child; child = next) {
        next = child->next;
        if (child->type == XML_TEXT_NODE) {
            xmlUnlinkNode(child);
            xmlFreeNode(child);
        } else {
            n++;
        }
    }
    return n;
}

static void branch(xmlNode *node)
{
    for (xmlNode *child = node->children; child; child = child->next)
        if (fl_is_container(child))
            branch(child);
    for (int n = drop_spaces(node); n > FEW;)
        n = group_children(node);
}

void fl_document_branch(xmlDoc *doc)
{
    for (xmlNode *node = doc->children; node; node = node->next)
        if (!is_plain(node))
            return;
    branch(xmlDocGetRootElement(doc));
}
