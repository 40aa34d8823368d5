/* Groups with many children become trees, so that one shape among thousands renders fast. */
#ifndef FLUIDY_SVG_BRANCH_H
#define FLUIDY_SVG_BRANCH_H

#include "svg/document.h"

/**
 * Puts the children of groups that have many into nested groups of a few each. To render one shape
 * librsvg visits all siblings of it and of the groups around it: n shapes in a row took n * n
 * visits, and take n log n in a tree.
 *
 * The picture is the same, since the document has no style sheets, which could match the groups.
 */
void fl_document_branch(xmlDoc *doc);

#endif
