/* Properties of CSS that become other elements and attributes of SVG 1.1. */
#ifndef FLUIDY_SVG_CSS_EFFECTS_H
#define FLUIDY_SVG_CSS_EFFECTS_H

#include "svg/css_shapes.h"

/** The values of such properties for one element. */
typedef struct FlCssEffects {
    GHashTable *value; // name, interned -> text; NULL if no property is set
} FlCssEffects;

/** Sets a property to a computed value, which it takes over. */
void fl_css_effects_set(FlCssEffects *effects, const char *name, char *value);

/** The value of a property; NULL if it is not set. */
const char *fl_css_effects_get(const FlCssEffects *effects, const char *name);

void fl_css_effects_clear(FlCssEffects *effects);

/**
 * Puts the properties and the attributes transform-origin and pathLength into effect; the children
 * of the element must be done. *n_clips counts the <clipPath> elements that are added.
 *
 * Returns: NULL, or the name of a property whose value cannot be drawn.
 */
const char *fl_css_effects_apply(const FlCssEffects *effects, xmlNode *node,
                                 const FlCssUnits *units, int *n_clips);

/**
 * Divides the widths of strokes with vector-effect: non-scaling-stroke by what scales them. Where
 * that differs by direction, the shape becomes a path in px of the page.
 */
void fl_css_keep_strokes(xmlNode *root, const FlCssUnits *units);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlCssEffects, fl_css_effects_clear)

#endif
