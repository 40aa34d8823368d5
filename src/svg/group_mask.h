/* Documents in which groups have no masks, and in which their masks alone are seen. */
#ifndef FLUIDY_SVG_GROUP_MASK_H
#define FLUIDY_SVG_GROUP_MASK_H

#include "svg/leaves.h"

/** Takes masks and clips off the groups of leaves->mask, and clips off those around them. */
void fl_group_masks_drop(xmlDoc *doc, const FlLeaves *leaves);

/**
 * Changes the document so that each group of that depth, rendered as a layer, shows the coverage of
 * its mask and of the clips on the group and around: the group is flooded, all other content is
 * removed.
 */
void fl_group_masks_flood(xmlDoc *doc, const FlLeaves *leaves, int depth);

#endif
