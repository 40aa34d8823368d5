/* BackgroundImage: filters that read the backdrop, as old versions of Inkscape wrote them. */
#ifndef FLUIDY_SVG_FILTER_BACKGROUND_H
#define FLUIDY_SVG_FILTER_BACKGROUND_H

#include "svg/document.h"

/**
 * Removes BackgroundImage and BackgroundAlpha from filters, since each shape is drawn by itself
 * over a transparent page: a filter that only blends with the backdrop becomes mix-blend-mode of
 * its element; for others the backdrop is empty, with a warning.
 */
void fl_document_drop_background(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

/** Returns: true if fl_document_drop_background() would change the document. */
bool fl_document_reads_background(const xmlDoc *doc);

#endif
