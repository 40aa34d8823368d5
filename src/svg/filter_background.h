/* BackgroundImage: filters that look at what is below, as old versions of Inkscape wrote them. */
#ifndef FLUIDY_SVG_FILTER_BACKGROUND_H
#define FLUIDY_SVG_FILTER_BACKGROUND_H

#include "svg/document.h"

/**
 * Takes BackgroundImage and BackgroundAlpha out of filters, for shapes are drawn one by one, where
 * nothing is below them: a filter that only blends with it becomes mix-blend-mode of what it is
 * for; to others the background is empty, with a warning.
 */
void fl_document_drop_background(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

#endif
