/* Opacity, masks, filters and blending: what is drawn on a surface of its own. */
#ifndef FLUIDY_SVG_EFFECTS_H
#define FLUIDY_SVG_EFFECTS_H

#include "svg/document.h"

/** Returns: true if a property is set, and not to none or normal. */
bool fl_is_set(const xmlNode *node, const char *property);

/** Returns: true if an element has a mask, a filter, a blend mode or an opacity below 1. */
bool fl_changes_as_one(const xmlNode *node);

/** Likewise, or if it is isolated, which keeps the blending in it from what lies below it. */
bool fl_has_effects(const xmlNode *node);

#endif
