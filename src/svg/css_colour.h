/* Colours of CSS [CSS Color 4 and 5], as sRGB. */
#pragma once

#include "svg/css_scan.h"
#include <stdint.h>

/**
 * A colour that librsvg draws as a browser does: #rrggbb and its like as they are, all others as
 * "rgb(r, g, b)" or "rgba(…)", cut to what sRGB can show. "none", "currentColor" and url(…) with a
 * colour after it are paints as well.
 *
 * Returns: the text, to be freed; NULL if it is no colour or paint.
 */
char *fl_css_colour(const char *text);

/** The levels and the opacity of a colour, 0 … 255 as librsvg rounds them. Returns: false if it is
 * no colour. */
bool fl_css_rgba(const char *text, uint8_t rgba[4]);

/** The same where functions may refer to currentColor, which is `current`. */
char *fl_css_colour_with(const char *text, const char *current);

/** The same with components of linear light; NULL if it is no colour alone. To be freed. */
char *fl_css_colour_in_linear_light(const char *text);
