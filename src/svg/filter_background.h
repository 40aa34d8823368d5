/* BackgroundImage: filters that read the backdrop, as old versions of Inkscape wrote them. */
#ifndef FLUIDY_SVG_FILTER_BACKGROUND_H
#define FLUIDY_SVG_FILTER_BACKGROUND_H

#include "svg/document.h"

/**
 * Removes BackgroundImage and BackgroundAlpha from filters, since shapes are drawn one by one over
 * nothing: a filter that only blends with the backdrop becomes mix-blend-mode of its element; for
 * others the backdrop is empty, with a warning.
 */
void fl_document_drop_background(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

/** Whether fl_document_drop_background() has something to remove. */
bool fl_document_reads_background(const xmlDoc *doc);

#endif
