/* What style sheets may say about groups: a guess, which drawing then checks. */
#ifndef FLUIDY_SVG_CSS_H
#define FLUIDY_SVG_CSS_H

#include "svg/document.h"

/** Properties that make the shapes of a group one thing to draw. */
typedef enum FlCssBits {
    FL_CSS_OPACITY = 1,
    FL_CSS_MASK = 2,
    FL_CSS_FILTER = 4,
    FL_CSS_BLEND = 8,
} FlCssBits;

/** Class and id selectors of a document's <style> elements, with the properties they set. */
typedef struct FlCss FlCss;

FlCss *fl_css_new(xmlDoc *doc);
void fl_css_free(FlCss *css); // NULL is fine

/**
 * The properties that rules for one of the node's classes, its id or its name may set. Conditions,
 * order and importance are ignored: a rule may not apply after all.
 */
unsigned fl_css_look_up(const FlCss *css, const xmlNode *node);

#endif
