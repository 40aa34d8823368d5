/* The cascade [CSS Cascade 5]: style sheets, properties and units become plain SVG 1.1. */
#pragma once

#include "svg/smil.h"

/**
 * Computes the style of every element as a browser does and writes it into the document, so that
 * librsvg and all other readers see the same values: declarations in `style`, transforms,
 * geometry and path data as attributes, clip shapes as <clipPath>. No style sheet remains.
 *
 * seconds: the moment at which CSS animations are shown; NAN: they are left out, with a warning.
 * length: collects the ends and loops of CSS animations; may be NULL.
 *
 * The real paths of imported sheets are added to `files`. Each kind of declaration that is left
 * out causes one warning. What a <use> shows is copied into it, and the <use> becomes a <g>.
 *
 * Returns: false with FL_ERROR_LIMIT if these copies are too many or too large.
 */
bool fl_cascade(xmlDoc *doc, const char *path, int number, double seconds, FlFilmLength *length,
                GPtrArray *files, FlWarnings *warnings, GError **error);
