/* Warns about what librsvg silently draws differently from a browser. */
#ifndef FLUIDY_SVG_LINT_H
#define FLUIDY_SVG_LINT_H

#include "svg/document.h"

/**
 * Adds a warning for each trap in the document, and mends two: a reference with a page address or
 * escapes, url(page.html#a), becomes url(#a) if the document has that id, and a gradient in HTML a
 * rectangle of its mean colour.
 */
void fl_lint(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

#endif
