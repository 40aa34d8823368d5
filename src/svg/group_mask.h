/* Documents in which groups have no masks, and in which their masks alone are seen. */
#ifndef FLUIDY_SVG_GROUP_MASK_H
#define FLUIDY_SVG_GROUP_MASK_H

#include "svg/leaves.h"

/** Takes masks and clips off the groups of leaves->mask, and clips off those around them. */
void fl_group_masks_drop(xmlDoc *doc, const FlLeaves *leaves);

/**
 * Makes each group of that depth, when it is the layer that is rendered, everything that its mask
 * and the clips on it and around it let through: the group is flooded, and nothing else is left.
 */
void fl_group_masks_flood(xmlDoc *doc, const FlLeaves *leaves, int depth);

#endif
