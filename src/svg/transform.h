/* Affine maps as SVG and CSS write them. */
#pragma once

#include "svg/affine.h"
#include "svg/css_value.h"
#include "svg/document.h"

/**
 * Reads the attribute's list of functions, "translate(3 4) rotate(10)". "none" and "" are the
 * identity. Returns: false if it cannot be parsed; *m is the identity then.
 */
bool fl_affine_parse(const char *text, FlAffine *m);

/**
 * Likewise the CSS property: with calc() and all units, percentages of units->width and height, and
 * functions in space, which are seen from straight above. *flat, unless it is NULL, becomes false
 * if the map has a vanishing point, which is left out.
 */
bool fl_affine_parse_css(const char *text, const FlCssUnits *units, FlAffine *m, bool *flat);

/** "matrix(…)", which both read; to be freed. */
char *fl_affine_text(const FlAffine *m);

/** Sets an attribute to that text. */
void fl_set_affine(xmlNode *node, const char *name, FlAffine m);

/** The transform of an element; the identity if librsvg rejects the attribute. */
FlAffine fl_affine_of(const xmlNode *node);
