/* Digests of leaves: leaves that are the same in two documents look the same. */
#ifndef FLUIDY_SVG_LEAF_DIGEST_H
#define FLUIDY_SVG_LEAF_DIGEST_H

#include "base/digest.h"
#include "svg/leaves.h"

/**
 * Digests all that a leaf of a normalised document is drawn from: its element, what the groups
 * around it say, style sheets and, where something refers to them, what is only drawn when it is
 * referred to. Files that it shows are expected to stay the same. Rather too much is digested than
 * too little.
 *
 * leaf: of leaves->leaf; unit: of leaves->unit, filled likewise. Both 0: unknown, unlike any other.
 */
void fl_leaf_digests(const xmlDoc *doc, const FlLeaves *leaves, FlDigest *leaf, FlDigest *unit);

#endif
