/* A copy of a document to read paints from: fast, and without what cairo's script surface lacks. */
#ifndef FLUIDY_SVG_PAINT_PROBE_H
#define FLUIDY_SVG_PAINT_PROBE_H

#include "svg/document.h"

/** How far paints are read from the upright, rad; see fl_paint_probe_prepare(). */
#define FL_PAINT_PROBE_TURN 0.3

/** Whether the document has images, patterns, or groups that librsvg draws on surfaces apart. */
bool fl_paint_probe_is_needed(xmlDoc *doc);

/**
 * Makes every image one grey pixel, which cairo's script surface would pack, and turns everything.
 * That surface fails for upright fills other than boxes, and stops the program at boxes farther
 * than 9999 px left of or above it. A turn of the whole page reaches neither patterns nor groups
 * with opacity, which librsvg draws on upright surfaces.
 */
void fl_paint_probe_prepare(xmlDoc *doc);

#endif
