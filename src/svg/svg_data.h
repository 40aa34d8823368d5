/* The data of an FlSvg and the librsvg handles that draw it; private to src/svg. */
#pragma once

#include "base/surface.h"
#include "svg/geometry.h"
#include "svg/leaf_paint.h"
#include <fluidy/error.h>

typedef struct FlSvg FlSvg;

struct FlSvg {
    char *path;
    double dpi;
    xmlDoc *doc;
    RsvgHandle *handle; // of the normalised document
    GHashTable *others; // real path of another file -> its elements, in svg_paint.c; made when
                        // it is first read, as is the next
    FlInheritance inheritance;
    int n_nameless;       // groups without an id
    GHashTable *variants; // handles of the document without some parts or masks
    FlLeaves *leaves;
    GHashTable *cover; // index of FlLeaves.mask -> A8 surface: the combined coverage of that mask
                       // and those around it; NULL: none was drawn
    FlPageSize cover_page; // that they are on
    size_t cover_bytes;    // of their surfaces
    GPtrArray *files;      // that it refers to
};

/** A handle of the document with that text; NULL with FL_ERROR_INPUT. */
RsvgHandle *fl_svg_make_handle(const FlSvg *svg, const char *text, size_t bytes, GError **error);

/** The handle for this part of the leaves, which svg owns; bare: without the masks of
 * FlLeaves.mask. NULL with FL_ERROR_INPUT. */
RsvgHandle *fl_svg_handle(FlSvg *svg, FlPart part, bool bare, GError **error);

/** Likewise the handle whose layers are the groups of that depth, each the coverage of its mask. */
RsvgHandle *fl_svg_mask_handle(FlSvg *svg, int depth, GError **error);

/** What its elements inherit on a page of that size; it belongs to svg. */
FlInheritance *fl_svg_inheritance(FlSvg *svg, FlPageSize page);

/** Sets FL_ERROR_INPUT in plain words. */
void fl_svg_set_error(const FlSvg *svg, const GError *reason, GError **error);

/** Frees the surfaces of all covers. */
void fl_svg_drop_covers(FlSvg *svg);
