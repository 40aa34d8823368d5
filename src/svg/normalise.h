/* Rewrites a document so that each shape can be rendered alone and the picture stays the same. */
#pragma once

#include "svg/document.h"

#define FL_WHOLE_ALL "*" // in place of an id: the document is one leaf

#define FL_GROUP_ID "fl-group-" // and a number: the ids that groups without one get

#define FL_SHAPE_AT "fl-shape-at-" // and FlLeaf.tree: in place of the id of a shape without one

/** Gives an id to every drawn <g>, <svg>, <a> and <use> without one, in document order. Returns:
 * all elements by id, as fl_document_ids() does. */
GHashTable *fl_document_name_groups(xmlDoc *doc, int *n_made);

/** Returns: true if node is drawn as one leaf: its id is in the list (NULL-terminated, or NULL). */
bool fl_is_whole(const xmlNode *node, const char *const *whole);

/**
 * Makes each <switch> a <g> with its first eligible child, and hides each <use> that shows nothing;
 * one that shows itself causes a warning.
 *
 * Returns: false with FL_ERROR_LIMIT if elements lie too deep.
 */
bool fl_document_normalise(xmlDoc *doc, GHashTable *ids, const char *path, int number,
                           FlWarnings *warnings, GError **error);

/** Returns: true if a <switch> may show this child. */
bool fl_is_eligible(const xmlNode *node);

/** Returns: true if children of node are drawn only by reference: <defs>, <mask>, … */
bool fl_is_undrawn(const xmlNode *node);
