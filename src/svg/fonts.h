/* The fonts of a drawing's text: files that it is made from although it does not name them. */
#ifndef FLUIDY_SVG_FONTS_H
#define FLUIDY_SVG_FONTS_H

#include <glib.h>
#include <libxml/tree.h>

/**
 * Adds to `files` the font files from which the document's text may be drawn: for each family that
 * it asks for, upright and slanted, regular and bold, the first fonts of fontconfig's order that
 * have its letters. Adds the folders of fonts, too, since one that is installed may come first.
 * Documents without text are left alone. Styles are computed, see svg/cascade.h; any thread.
 */
void fl_fonts_add(xmlDoc *doc, GPtrArray *files);

#endif
