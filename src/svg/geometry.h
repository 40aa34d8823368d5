/* The outlines of a drawing's leaves, read from its document; motion is computed from them. */
#pragma once

#include "svg/inherited.h"
#include "svg/leaves.h"
#include "svg/pen.h"

typedef enum FlOutlineKind {
    FL_OUTLINE_NONE, // text, an image, a group drawn as one: no outline
    FL_OUTLINE_PATH,
    FL_OUTLINE_CIRCLE,
    FL_OUTLINE_ELLIPSE,
    FL_OUTLINE_RECT,
    FL_OUTLINE_POLY, // line, polyline, polygon
} FlOutlineKind;

/** One leaf's outline. Names are hashes, to be compared only; 0 is "". */
typedef struct FlGeometry {
    FlAffine ctm; // from local coordinates to px of the picture
    int32_t first_subpath, n_subpaths;
    uint64_t id;     // as authored
    uint64_t labels; // of it and its groups, without digits
    uint64_t tree;   // its position in the tree
    uint64_t group;  // the position of its parent
    double stroke;   // width in local units; 0: no stroke, or unknown
    uint8_t kind;    // FlOutlineKind
    uint8_t usable;  // the outline was parsed completely, and its points are finite
    uint8_t clipped; // a clip, mask or filter may hide a part
    uint8_t evenodd; // the fill rule
    uint8_t filled;
    uint8_t unused[7];
    int32_t unit; // FlLeaf.unit
} FlGeometry;

/** The outlines of a frame's leaves, by their index. The three arrays are its only pointers. */
typedef struct FlOutlines {
    int n_leaves, n_subpaths, n_cubics;
    FlGeometry *leaf;
    FlSubpath *subpath;
    FlCubic *cubic;
} FlOutlines;

/**
 * Reads the outlines of leaves in their normalised document.
 *
 * An arc is always four cubics and a rectangle always eight, so that a shape keeps its structure
 * while its numbers change; a closing line of no length is dropped.
 */
FlOutlines *fl_outlines_new(FlInheritance *inheritance, const FlLeaves *list);

/**
 * The outline of a path or basic shape alone, in local coordinates; percentages are of `viewport`,
 * in user units. Returns: no subpaths if it is another element or cannot be read.
 */
FlOutlines *fl_outlines_of_shape(const xmlNode *node, double dpi, FlPageSize viewport);

/** What a pen has drawn, without leaves; takes its arrays over. */
FlOutlines *fl_outlines_of_pen(FlPen *pen);

/** Makes the picture that they are in `factor` times as large. */
void fl_outlines_scale(FlOutlines *outlines, double factor);

void fl_outlines_free(FlOutlines *outlines); // NULL is fine

/** Serialises the outlines; to be freed with g_free(). */
uint8_t *fl_outlines_pack(const FlOutlines *outlines, size_t *bytes);

/** Reads what the same program serialised. Returns: NULL if it is damaged. */
FlOutlines *fl_outlines_unpack(const uint8_t *data, size_t bytes);

/** The point of a cubic at t, 0 … 1, in px. */
FlPoint fl_cubic_at(const FlCubic *cubic, const FlAffine *ctm, double t);

/** The number of straight pieces of about step_px that a cubic is split into, 1 … 400. */
int fl_cubic_steps(const FlCubic *cubic, const FlAffine *ctm, double step_px);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlOutlines, fl_outlines_free)
