/* Properties of CSS that become other elements and attributes of SVG 1.1. */
#pragma once

#include "svg/css_shapes.h"

/**
 * Puts such properties of an element and its attributes transform-origin and pathLength into
 * effect; its children must be done. effects: the computed values by their names; NULL: none.
 * *n_clips counts the <clipPath> elements that are added.
 *
 * Returns: NULL, or the name of a property whose value cannot be drawn.
 */
const char *fl_css_effects_apply(GHashTable *effects, xmlNode *node, const FlCssUnits *units,
                                 int *n_clips);

/**
 * Divides the widths of strokes with vector-effect: non-scaling-stroke by what scales them. Where
 * that differs by direction, the shape becomes a path in px of the page.
 */
void fl_css_keep_strokes(xmlNode *root, const FlCssUnits *units);
