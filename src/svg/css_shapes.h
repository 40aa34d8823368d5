/* The geometry of shapes for the cascade: boxes, lengths, places on a path, outlines. */
#ifndef FLUIDY_SVG_CSS_SHAPES_H
#define FLUIDY_SVG_CSS_SHAPES_H

#include "svg/document.h"
#include "svg/transform.h"

typedef struct FlCssBox {
    double x, y, width, height;
} FlCssBox;

/**
 * The box of an element's fill in its own coordinates; for a group, of all its content, whose
 * transforms must be attributes already. Text has no box.
 *
 * Returns: false if it has no outline.
 */
bool fl_css_fill_box(const xmlNode *node, const FlCssUnits *units, FlCssBox *box);

/** The length of a shape's outline in user units; 0 without an outline. */
double fl_css_outline_length(const xmlNode *node, const FlCssUnits *units);

/** A place at a distance along path data, and the direction there in degrees; false: no path. */
bool fl_css_place_on_path(const char *d, const char *distance, const FlCssUnits *units,
                          FlPoint *place, double *direction);

/** A shape's outline, mapped by `map`, as path data; NULL without an outline. To be freed. */
char *fl_css_outline_text(const xmlNode *node, const FlCssUnits *units, const FlAffine *map);

/**
 * The path data of circle(), ellipse(), inset(), rect(), xywh(), polygon() or path() in a box [CSS
 * Shapes 1]; NULL for other text. *evenodd: its fill rule. To be freed.
 */
char *fl_css_basic_shape(const char *text, const FlCssUnits *units, FlCssBox box, bool *evenodd);

/**
 * A place in a box: "left top", "50% 10px", "center"; a third value, the depth, does not count.
 * Returns: false if it cannot be read.
 */
bool fl_css_position(const char *text, const FlCssUnits *units, FlCssBox box, FlPoint *place);

#endif
