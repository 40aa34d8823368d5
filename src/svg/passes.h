/* The passes over a document between the cascade and its leaves. */
#pragma once

#include "svg/document.h"

/* ---- what librsvg draws differently, or must not read ---------------------------------------- */

/**
 * Adds a warning for each trap in the document, and mends two: a reference with a page address or
 * escapes, url(page.html#a), becomes url(#a) if the document has that id, and a gradient in HTML a
 * rectangle of its mean colour.
 */
void fl_lint(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

/**
 * Checks every <image> and <feImage> of a document without decoding its pixels. Warns about those
 * that librsvg will not show: files that are missing or outside the drawing's folder, by whatever
 * path or symbolic link, and network addresses. References of any element to pipes and devices are
 * removed. The real paths of files that exist are added to `files`, see g_ptr_array_new().
 *
 * Returns: false with FL_ERROR_LIMIT set if an image has too many pixels.
 */
bool fl_images_check(xmlDoc *doc, const char *path, int number, GPtrArray *files,
                     FlWarnings *warnings, GError **error);

/**
 * Rewrites what librsvg leaves out and a browser draws: <feDropShadow>, clips of clip paths,
 * gradients of no length, lists of points that break. Languages in a <switch> are resolved, and a
 * <mask> has no mask. Filters that only blend with the background become blend modes; others read
 * an empty one, by the name of FL_NO_BACKGROUND.
 */
void fl_document_mend(xmlDoc *doc, const char *path, int number, FlWarnings *warnings);

#define FL_NO_BACKGROUND "fl-no-background"

/** A part of it, for shapes that are turned: round blurs, and paints in units of their box. Warns
 * of filters that are not turned, and if filters and patterns became too many. */
void fl_document_mend_turned(xmlDoc *doc, GHashTable *ids, const char *path, int number,
                             FlWarnings *warnings);

/* ---- the fonts of its text ------------------------------------------------------------------- */

/**
 * Adds to `files` the font files from which the document's text may be drawn: for each family that
 * it asks for, upright and slanted, regular and bold, the first fonts of fontconfig's order that
 * have its letters. Adds the folders of fonts, too, since one that is installed may come first.
 * Documents without text are left alone. Styles are computed, see svg/cascade.h; any thread.
 */
void fl_fonts_add(xmlDoc *doc, GPtrArray *files);

/* ---- groups with many children --------------------------------------------------------------- */

/**
 * Puts the children of groups that have many into nested groups of a few each. To render one shape,
 * librsvg visits all its siblings and those of each group around. For n shapes in one row that is n
 * * n visits, in a tree n log n.
 *
 * The picture is the same, since the document has no style sheets, which could match the groups.
 */
void fl_document_branch(xmlDoc *doc);
