/* Names that tell something: layer labels and ids that people gave, not those programs make up. */
#ifndef FLUIDY_SVG_LABELS_H
#define FLUIDY_SVG_LABELS_H

#include <libxml/tree.h>
#include <stdbool.h>

/**
 * What names a group: its inkscape:label, its Flash character, the name that Affinity, Illustrator
 * or Linearity keep beside ids, else its id (which may be NULL) or, if that tells nothing, its
 * <title>.
 *
 * Numbered words such as "Group 1", "path2995", "__lottie_element_4" and random ids tell nothing,
 * unless they are the label of a layer. Illustrator's "tree_3_" is "tree". Shapes have no label.
 *
 * Returns: to be freed with g_free(); NULL if nothing tells.
 */
char *fl_label_of(const xmlNode *node, const char *id, bool *is_layer);

/** Whether a name is one that programs make up. */
bool fl_label_is_generic(const char *name);

#endif
