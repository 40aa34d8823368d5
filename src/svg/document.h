/* An SVG file as a DOM, read with limits: SVG files are untrusted. */
#pragma once

#include "base/each.h"
#include "base/warnings.h"
#include "svg/css_value.h"
#include <fluidy/error.h>
#include <libxml/tree.h>
#include <stdbool.h>

#define FL_SVG_NAMESPACE "http://www.w3.org/2000/svg"

G_DEFINE_AUTOPTR_CLEANUP_FUNC(xmlDoc, xmlFreeDoc)
G_DEFINE_AUTOPTR_CLEANUP_FUNC(xmlChar, xmlFree)

/**
 * Reads a .svg or .svgz file. Does not access the network and does not replace entities.
 *
 * A prologue that is no XML (Blender 4 writes one) is dropped with a warning; undeclared namespace
 * prefixes are declared. number is the frame's, for the warnings.
 *
 * Returns: the document, whose root is an <svg>; NULL with FL_ERROR_INPUT (not readable, no SVG;
 * with the line) or FL_ERROR_LIMIT.
 */
xmlDoc *fl_document_read(const char *path, int number, FlWarnings *warnings, GError **error);

/** Likewise reads a document from its text; `path` names it in messages. */
xmlDoc *fl_document_parse(const char *text, size_t bytes, const char *path, int number,
                          FlWarnings *warnings, GError **error);

/** Returns: true if a text of so many bytes, or a limit that was raised, is beyond what libxml2 and
 * librsvg take by themselves. */
bool fl_document_is_huge(size_t bytes);

/** The document as XML; to be freed with g_free(). */
char *fl_document_text(xmlDoc *doc, size_t *bytes);

/** A table from id to the first xmlNode of that id; to be unref'd. */
GHashTable *fl_document_ids(xmlDoc *doc);

/** Returns: true if node is an SVG element of that name. */
bool fl_is(const xmlNode *node, const char *name);

/** Returns: true if node is an SVG element whose name is one of the words. */
bool fl_is_one_of(const xmlNode *node, const char *names);

/** Returns: true if an element is in no other one. */
bool fl_is_root(const xmlNode *node);

/** The element around a node; NULL around the root. */
xmlNode *fl_element_around(const xmlNode *node);

/** Returns: true if node is a container of elements: <g>, <svg> or <a>. */
bool fl_is_container(const xmlNode *node);

/** An attribute without a namespace; NULL if absent. It lasts until the attribute is set again. */
const char *fl_attribute(const xmlNode *node, const char *name);

/** Sets an attribute without a namespace; removes it if the value is NULL or "". */
void fl_set_attribute(xmlNode *node, const char *name, const char *value);

/** Sets an attribute to n numbers with spaces between them. */
void fl_set_numbers(xmlNode *node, const char *name, const double *v, int n);

/** Reads viewBox: x, y, width and height. Returns: false if it is missing, damaged or empty; *box
 * stays as it is then. */
bool fl_view_box(const xmlNode *node, double box[4]);

/** An attribute with any prefix, be it declared or not, trimmed; NULL if absent. g_free(). */
char *fl_foreign_attribute(const xmlNode *node, const char *name);

/** Visits the elements among the children of a node, which stay in their places. */
#define FL_EACH_ELEMENT(child, node)                                                               \
    for (xmlNode *child = xmlFirstElementChild((xmlNode *)(node)); child;                          \
         child = xmlNextElementSibling(child))

/** The href of an element, with a prefix or without; to be freed with g_free(); NULL without one.
 */
char *fl_href(const xmlNode *node);

/** Removes the href of an element, with whatever prefix. */
void fl_drop_href(xmlNode *node);

/** Returns: true if node is an element of SMIL that animates another. */
bool fl_is_animation(const xmlNode *node);

/**
 * A property from `style=""` or else from the attribute of that name, trimmed; NULL if it is in
 * neither place. Style sheets are ignored. To be freed with g_free().
 */
char *fl_property(const xmlNode *node, const char *name);

/** Likewise, of the innermost element around that says it, if the element itself does not. */
char *fl_inherited_property(const xmlNode *node, const char *name);

/** A property or attribute that is a length, of which `whole` is 100 %; 0 if it is none. */
double fl_length_of(const xmlNode *node, const char *name, const FlCssUnits *units, double whole);

/** The element, of one of the words, that a value, url(#id), refers to; NULL without one. */
xmlNode *fl_referred_by(const char *value, const char *kinds, GHashTable *ids);

/**
 * Adds declarations, such as "fill:none !important", to those of `style=""`. Returns: false if
 * `style=""` already ended with these declarations.
 */
bool fl_declare(xmlNode *node, const char *format, ...) G_GNUC_PRINTF(2, 3);

/** Returns: true if a property is set, and not to none or normal. */
bool fl_is_set(const xmlNode *node, const char *property);

/** Returns: true if an element has a mask, a filter, a blend mode or an opacity below 1. */
bool fl_changes_as_one(const xmlNode *node);

/** Likewise, or if it is isolated, which keeps the blending in it from what lies below it. */
bool fl_has_effects(const xmlNode *node);

/**
 * The real path, with links resolved, of the file that `href` in the file `from` names, even if it
 * does not exist. *is_there: true if it exists. Returns: NULL if href names no file; to be freed.
 */
char *fl_reference_file(const char *from, const char *href, bool *is_there);

/** Returns: true if a real path is in the folder of the drawing or in a folder below. */
bool fl_reference_is_inside(const char *drawing, const char *file);
