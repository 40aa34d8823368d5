/* What the style sheets of a drawing know its elements by. */
#ifndef FLUIDY_SVG_SELECTORS_H
#define FLUIDY_SVG_SELECTORS_H

#include "svg/document.h"

typedef enum FlSelectors {
    FL_SELECTORS_PLAIN = 0,      // classes and names of elements, but not of <g>
    FL_SELECTORS_IDS = 1 << 0,   // ids
    FL_SELECTORS_PLACES = 1 << 1 // anything else: <g>, children, siblings, attributes, files
} FlSelectors;

/** The kinds of selectors in all style sheets of a document. Rather too many than too few. */
FlSelectors fl_document_selectors(const xmlDoc *doc);

#endif
