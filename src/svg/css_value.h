/* Values of CSS: variables, numbers with units and calc() [CSS Values 4]. */
#pragma once

#include "svg/css_scan.h"

/** The reference lengths of relative units, px. */
typedef struct FlCssUnits {
    double width, height; // of the viewport, in user units: 100 %
    double font_size, root_font_size;
    double page_width, page_height; // of vw and vh
    double dpi;                     // px per inch; 0: 96
    bool bare;                      // lengths need no unit, as in attributes
} FlCssUnits;

/** Kinds of values. */
enum {
    FL_CSS_PLAIN = 1, // a number without unit
    FL_CSS_SIZE = 2,
    FL_CSS_SHARE = 4, // %
    FL_CSS_ANGLE = 8,
    FL_CSS_OTHER = 16, // a time, a resolution
};

/** Finds the value of a custom property; NULL: it is not set. */
typedef const char *FlCssVariable(const void *data, const char *name);

/**
 * Puts the values of var() and env() in for them.
 *
 * Returns: the text, to be freed; NULL if a variable is not set and has no fallback, if variables
 * refer to each other in a circle, or if the text becomes longer than 64 KiB.
 */
char *fl_css_substitute(const char *value, FlCssVariable *variable, const void *data);

/**
 * Reads one number with or without a unit, or calc(), min(), max(), clamp(), abs(), round() … of
 * such. Lengths become px, angles degrees, times seconds; 100% is `whole`.
 *
 * Returns: false if `text` is anything else or not finite.
 */
bool fl_css_number(const char *text, const FlCssUnits *units, double whole, double *value);

/** Reads a number that measures one of `kinds`. Returns: false if it is of another kind, but for a
 * length or an angle of 0. */
bool fl_css_amount(const char *text, int kinds, const FlCssUnits *units, double whole,
                   double *value);

/** The text of a number in as few digits as give it back within a millionth; to be freed. */
char *fl_css_number_text(double value);
