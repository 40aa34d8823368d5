/* Digests of leaves: leaves that are the same in two documents look the same. */
#ifndef FLUIDY_SVG_LEAF_DIGEST_H
#define FLUIDY_SVG_LEAF_DIGEST_H

#include "base/digest.h"
#include "svg/svg_frame.h"

/**
 * Digests all that a leaf is drawn from: its element, what the groups around it say, style sheets
 * and, where something refers to them, definitions and the paths of files. What is in a file is
 * expected to stay the same. Rather too much is digested than too little.
 *
 * leaf, unit: one for each in the lists of fl_svg_leaves(), filled; that of nothing: unknown.
 */
void fl_leaf_digests(FlSvg *svg, FlDigest *leaf, FlDigest *unit);

#endif
