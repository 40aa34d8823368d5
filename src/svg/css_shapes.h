/* The geometry of shapes for the cascade: boxes, lengths, places on a path, outlines. */
#pragma once

#include "svg/geometry.h"
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

/** A shape's outline in its own coordinates; it has no cubics without an outline. */
FlOutlines *fl_css_outlines(const xmlNode *node, const FlCssUnits *units);

/** That of path data; NULL if these are broken. */
FlOutlines *fl_css_outlines_of_path(const char *d);

/** That of circle(), ellipse(), inset(), rect(), xywh(), polygon() or path() in a box [CSS Shapes
 * 1]; NULL for other text. *evenodd: its fill rule. */
FlOutlines *fl_css_basic_shape(const char *text, const FlCssUnits *units, FlCssBox box,
                               bool *evenodd);

/** Walks along outlines. Returns: the length up to `target`, where it stops with the place and the
 * direction in degrees. */
double fl_css_walk_along(const FlOutlines *outlines, double target, FlPoint *place,
                         double *direction);

/** Outlines, mapped by `map`, as path data; NULL if there is none. To be freed. */
char *fl_css_outline_text(const FlOutlines *outlines, const FlAffine *map);

/**
 * A place in a box: "left top", "50% 10px", "center"; a third value, the depth, does not count.
 * Returns: false if it cannot be read.
 */
bool fl_css_position(const char *text, const FlCssUnits *units, FlCssBox box, FlPoint *place);
