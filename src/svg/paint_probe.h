/* Prepares a copy of a document from which paints are read by cairo's script surface. */
#ifndef FLUIDY_SVG_PAINT_PROBE_H
#define FLUIDY_SVG_PAINT_PROBE_H

#include "svg/document.h"

/** The rotation at which paints are read, rad; see fl_paint_probe_prepare(). */
#define FL_PAINT_PROBE_TURN 0.3

/** Returns: true if the paints of all leaves must be read from a copy that fl_paint_probe_prepare()
 * has changed, and not only the paints of leaves with FlLeaf.effects: any leaf may show a pattern
 * or another definition with effects, or get effects from a style sheet; or a clip path is vast. */
bool fl_paint_probe_is_needed(xmlDoc *doc);

/**
 * Leaves out masks and clip paths, which hide paint and do not change it, but are most of what
 * librsvg would do.
 * Makes every image one grey pixel, since cairo's script surface would store it, and rotates
 * everything: that surface fails for axis-aligned fills other than boxes, and aborts at boxes more
 * than 9999 px beyond its left or upper side. Rotating the page alone reaches neither patterns nor
 * groups with opacity, which librsvg draws on axis-aligned surfaces.
 */
void fl_paint_probe_prepare(xmlDoc *doc);

#endif
