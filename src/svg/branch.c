#include "svg/passes.h"

#define FEW 24 // children that a group may have; 12 to 48 take the same time with 8000 shapes

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

/** Drops the white space between elements: librsvg visits that space, like any node. Returns: the
 * number of children that are left. */
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
    branch(xmlDocGetRootElement(doc));
}
