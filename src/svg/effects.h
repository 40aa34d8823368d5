/* Opacity, masks, filters and blending: what is drawn on a surface of its own. */
#ifndef FLUIDY_SVG_EFFECTS_H
#define FLUIDY_SVG_EFFECTS_H

#include "svg/document.h"

/** Whether a property is set, and not to none or normal. Style sheets are ignored. */
bool fl_is_set(const xmlNode *node, const char *property);

/** Whether an element has a mask, a filter, a blend mode or an opacity below 1, or is isolated.
 * Style sheets are ignored. */
bool fl_has_effects(const xmlNode *node);

#endif
