/* Opacity, masks, filters and blending: what is drawn on a surface of its own. */
#ifndef FLUIDY_SVG_EFFECTS_H
#define FLUIDY_SVG_EFFECTS_H

#include "svg/document.h"

/* Style sheets are ignored. */

/** Whether a property is set, and not to none or normal. */
bool fl_is_set(const xmlNode *node, const char *property);

/** Whether an element blends, or its opacity is below 1, or it has a mask or a filter or is
 * isolated. */
bool fl_has_effects(const xmlNode *node);

#endif
