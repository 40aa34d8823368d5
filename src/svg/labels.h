/* Meaningful names: layer labels and ids that people gave, not generated ones. */
#pragma once

#include <libxml/tree.h>
#include <stdbool.h>

/**
 * The label of a group: its inkscape:label, its Flash character, the name that Affinity,
 * Illustrator or Linearity keep beside ids, else its id (which may be NULL) or, if that is
 * generated, its <title>.
 *
 * Numbered words such as "Group 1", "path2995", "__lottie_element_4" and random ids are generated,
 * unless they are the label of a layer. Illustrator's "tree_3_" is "tree". Shapes have no label.
 *
 * Returns: to be freed with g_free(); NULL if there is no meaningful name.
 */
char *fl_label_of(const xmlNode *node, const char *id, bool *is_layer);
