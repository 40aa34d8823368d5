/* Digests of leaves: leaves that are the same in two documents look the same. */
#ifndef FLUIDY_SVG_LEAF_DIGEST_H
#define FLUIDY_SVG_LEAF_DIGEST_H

#include "base/digest.h"
#include "svg/svg_frame.h"

/**
 * Digests all that a leaf is drawn from: its element, the attributes of the groups around, style
 * sheets and, if an element refers to them, definitions and the paths of files. The contents of
 * files are assumed to be unchanged. In doubt an element is included.
 *
 * leaf, unit: arrays to fill, one digest for each leaf and unit of fl_svg_leaves(); a zero digest
 * means unknown.
 */
void fl_leaf_digests(FlSvg *svg, FlDigest *leaf, FlDigest *unit);

#endif
