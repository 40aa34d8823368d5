/* Groups with many children become trees, so that one shape among thousands renders fast. */
#ifndef FLUIDY_SVG_BRANCH_H
#define FLUIDY_SVG_BRANCH_H

#include "svg/document.h"

/**
 * Puts the children of groups that have many into nested groups of a few each. To render one shape,
 * librsvg visits all its siblings and those of each group around. For n shapes in one row that is n
 * * n visits, in a tree n log n.
 *
 * The picture is the same, since the document has no style sheets, which could match the groups.
 */
void fl_document_branch(xmlDoc *doc);

#endif
