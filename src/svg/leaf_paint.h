/* The computed paint of a leaf, read from the document as the cascade left it. */
#pragma once

#include "base/blend_mode.h"
#include <glib.h>
#include <stdbool.h>
#include <stdint.h>

typedef enum FlPaintKind {
    FL_PAINT_FLAT,     // one colour
    FL_PAINT_GRADIENT, // linear or radial
    FL_PAINT_IMAGE,    // a raster image, a pattern, or the result of a filter
    FL_PAINT_MIXED,    // several of these
} FlPaintKind;

/** The parts of a leaf that are drawn separately. */
typedef enum FlPart {
    FL_PART_WHOLE,
    FL_PART_FILL,
    FL_PART_STROKE,
} FlPart;

/**
 * A computed paint. Two are the same paint if their keys are equal: "#rrggbb" for a flat one,
 * the kind and the stops for a gradient (neither its id nor its position).
 */
typedef struct FlSvgPaint {
    FlPaintKind kind;
    uint8_t rgb[3]; // the colour; of a gradient the mean over its stops
    uint8_t alpha;  // opacity, its groups included; of a gradient the mean
    uint8_t peak;   // the opacity where it is most opaque: of a gradient its most opaque stop
    char *key;      // owned
} FlSvgPaint;

/** A part of a leaf and its paint. */
typedef struct FlPainted {
    FlPart part;
    bool stroke;            // the part consists of strokes only
    FlBlendMode blend_mode; // of the whole part; OVER if it has several modes
    float width;            // of its widest stroke, px of the page; 0: no stroke
    FlSvgPaint paint;
} FlPainted;

#define FL_MOST_PARTS 2

void fl_svg_paint_clear(FlSvgPaint *paint);
