/* One frame: an SVG file, normalised, whose leaves can be drawn one by one. */
#pragma once

#include "base/surface.h"
#include "svg/geometry.h"
#include "svg/leaf_paint.h"
#include <fluidy/render.h>

/** The page of drawings without a size, in user units. */
typedef struct FlCanvas {
    double x, y, width, height; // width 0: the file's own
} FlCanvas;

/** Reads "WxH" or "WxH+X+Y" in px. FL_ERROR_USAGE. */
bool fl_canvas_parse(const char *text, FlCanvas *canvas, GError **error);

typedef struct FlSvgOptions {
    FlCanvas canvas;
    double dpi;               // of mm, cm, in, pt; 0: 96
    const char *const *whole; // ids of groups that are drawn as one leaf; may be NULL
    FlFramesFrom from;        // LAYERS, PAGES or TIME: the frame is one of several in the file
    int layer;                // its layer or page, from 1
    double seconds;           // its moment, from the start of the animations
} FlSvgOptions;

/** A frame. One thread at a time may use a frame; different frames may be used in parallel. */
typedef struct FlSvg FlSvg;

/** Reads, normalises and parses. Returns: NULL with FL_ERROR_INPUT or FL_ERROR_LIMIT. */
FlSvg *fl_svg_open(const char *path, int number, const FlSvgOptions *options, FlWarnings *warnings,
                   GError **error);

/** The same for its leaves and its document only: it cannot be drawn. */
FlSvg *fl_svg_read(const char *path, int number, const FlSvgOptions *options, FlWarnings *warnings,
                   GError **error);

void fl_svg_free(FlSvg *svg); // NULL is fine

/**
 * The page in px: width and height of the file, else of its viewBox.
 * Returns: false with FL_ERROR_INPUT, which suggests ‘canvas’, if it has neither.
 */
bool fl_svg_size(const FlSvg *svg, double *width, double *height, GError **error);

/** The number of groups without an id; documents with equal numbers have comparable generated ids.
 */
int fl_svg_nameless_groups(const FlSvg *svg);

/** The real paths, char *, of the files that it refers to and that exist; of its text the fonts and
 * all folders of fonts. */
const GPtrArray *fl_svg_files(const FlSvg *svg);

/** The leaves, bottom up; they belong to svg. */
const FlLeaves *fl_svg_leaves(const FlSvg *svg);

/** The normalised document, in which the leaves have their ids; it belongs to svg. */
xmlDoc *fl_svg_document(const FlSvg *svg);

/** The outlines of its leaves; to be freed with fl_outlines_free(). */
FlOutlines *fl_svg_outlines(FlSvg *svg, FlPageSize page);

/**
 * The computed paints of a leaf. A leaf whose fill and stroke have the same opaque paint is one
 * part, and so is one with a blend mode.
 * Returns: the number of parts, bottom up, which need not cover anything; 0 if it has no paint.
 */
int fl_svg_leaf_paints(FlSvg *svg, const FlLeaf *leaf, FlPageSize page,
                       FlPainted parts[FL_MOST_PARTS]);

/**
 * Draws a part of a leaf at its place in the picture, with its clip, mask and groups. The drawing
 * is scaled to the page.
 */
bool fl_svg_draw(FlSvg *svg, const FlLeaf *leaf, FlPart part, cairo_t *cr, FlPageSize page,
                 GError **error);

/**
 * The box of a leaf, its strokes included and clips not, in px of the page; empty if the leaf is.
 */
RsvgRectangle fl_svg_extents(FlSvg *svg, const FlLeaf *leaf, FlPageSize page);

/** Draws a group of that id (NULL: everything) as one. */
bool fl_svg_draw_group(FlSvg *svg, const char *id, cairo_t *cr, FlPageSize page, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlSvg, fl_svg_free)
