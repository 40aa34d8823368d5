/* The properties that elements of a drawing inherit: where they are, and what they are painted
 * with. */
#pragma once

#include "svg/affine.h"
#include "svg/document.h"

#define FL_MARKERS 3 // at the start, in the middle and at the end of a line

/** The size of a page when it is drawn, px; above 0. */
typedef struct FlPageSize {
    double width, height;
} FlPageSize;

/** The properties of an element, inherited ones and its own. Texts are as the cascade left them,
 * and belong to the FlInheritance. */
typedef struct FlInherited {
    FlAffine ctm;         // from local coordinates to px of the page
    double width, height; // of the viewport, for percentages
    bool clipped, evenodd, hidden;
    bool stroke_first; // it is below the fill
    bool broken;       // something could not be parsed
    double stroke_width;
    double fill_opacity, stroke_opacity;
    const char *fill, *stroke, *color;
    const char *marker[FL_MARKERS];
} FlInherited;

/** A document that is asked for them. */
typedef struct FlInheritance {
    double dpi;
    FlPageSize page;
    GHashTable *known; // xmlNode -> FlInherited
    GStringChunk *text;
} FlInheritance;

/** Maps a viewBox into a viewport of width x height, as preserveAspectRatio says; `ratio` may be
 * NULL. */
FlAffine fl_fit_box(const double box[4], double width, double height, const char *ratio);

FlInheritance fl_inheritance_of(double dpi, FlPageSize page);
void fl_inheritance_clear(FlInheritance *inheritance);

/** Those of an element at its place. */
FlInherited fl_inherited_by(FlInheritance *inheritance, const xmlNode *node);

/** Those of an element that a <use> with these properties shows. */
FlInherited fl_inherited_from(FlInheritance *inheritance, const xmlNode *node,
                              const FlInherited *around);

/** The length of an attribute or property in px, or `initial`; `whole` is what 100% is. *broken is
 * set if it cannot be parsed. */
double fl_length_in(const FlInheritance *inheritance, const xmlNode *node, const char *name,
                    double whole, double initial, bool *broken);

/** A number or percentage within 0 … 1; without a number `initial`. */
double fl_share_in(const xmlNode *node, const char *name, double initial);
