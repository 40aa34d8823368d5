/* Values between two others, as SMIL and CSS animations want them. */
#pragma once

#include "svg/css_value.h"

/** The y of a cubic from 0,0 to 1,1 with those two control points, at an x of 0 … 1. */
double fl_ease(const double control[4], double x);

/** Progress through a timing function of CSS, such as "ease-in" or "steps(4, end)". */
double fl_css_ease(const char *function, double x);

/**
 * The value at a share p from `a` to `b`; p may lie beyond 0 … 1. Texts that differ in their
 * numbers only, colours, and lengths in different units have values between; path data and
 * transforms are such texts. fl_add_values() adds such values.
 *
 * Returns: the text, to be freed; NULL if the values cannot be interpolated.
 */
char *fl_interpolate(const char *a, const char *b, double p);

/** a + n * b, number by number; NULL if the texts differ in more than numbers. To be freed. */
char *fl_add_values(const char *a, const char *b, double n);

/** The distance of two values, for even speed; 1 if it is unknown. */
double fl_value_distance(const char *a, const char *b);

/** The value of translate, rotate or scale at a share p; words that one of them lacks change
 * nothing. To be freed; NULL: there is none between. */
char *fl_interpolate_words(const char *property, const char *a, const char *b, double p);

/** Likewise of lists of functions with the same names, of which one may be shorter; `separator`
 * stands between their arguments. */
char *fl_interpolate_functions(const char *a, const char *b, double p, char separator);

/**
 * The transform at a share p between two lists of functions [CSS Transforms 1 §12]. Lists of other
 * functions are decomposed in a box of units->width x height. To be freed; NULL: not readable.
 */
char *fl_interpolate_transform(const char *a, const char *b, double p, const FlCssUnits *units);
