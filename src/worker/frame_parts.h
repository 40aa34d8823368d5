/* The parts of a frame: where they are, with which paint, and how they are called. */
#pragma once

#include "svg/pose.h"
#include "svg/svg_frame.h"

#define FL_SURVEY_MOST_SIDE 32767 // px; cairo's limit

/** Strings as numbers, so that they are kept once and compared fast. 0 is "". */
typedef struct FlStrings {
    GPtrArray *text;
    GHashTable *number;
} FlStrings;

int fl_strings_add(FlStrings *strings, const char *text);
const char *fl_strings_get(const FlStrings *strings, int number);
void fl_strings_clear(FlStrings *strings);

/** A part of a leaf, or a unit, in one frame. Strings are numbers in an FlStrings. */
typedef struct FlSurveyPart {
    int leaf; // index of the leaf; of a unit -1 - its index
    FlPart part;
    bool stroke;
    bool has_fill, has_stroke; // of its leaf
    float width;               // of a stroke, px of the picture; 0: a fill alone; below 0: neither
    bool thick;                // a stroke without a fill that is a limb rather than a line
    FlPaintKind kind;
    uint8_t rgb[3], alpha, peak; // see FlSvgPaint
    FlBlendMode blend_mode;
    int paint; // FlSvgPaint.key
    int name, labels, layers, ids, classes, tree;
    float box[4];  // x0, y0, x1, y1 of what is drawn, px of the picture; a pixel too wide
    float area_px; // sum of its coverage
    FlPose pose;   // of the outline of the leaf or unit
    float covers;  // share of it that lies over other paint, page-filling ones not counted
    int unit;      // 1 + index of the unit it is, or is a leaf of, if that is to be drawn as one
    int region;    // set later; -1: not drawn
    int nth; // set later: its track, then the first, second, … leaf that the region has in the film
} FlSurveyPart;

/** A frame as it was read. */
typedef struct FlSurveyFrame {
    GArray *parts;   // FlSurveyPart, bottom up
    FlPageSize page; // px of the picture
    FlCanvas canvas; // the frame's page; the caller's
    char **whole;    // FlSvgOptions.whole; NULL: no list
    int n_nameless;  // groups without an id
    char **files;    // real paths of the files that it refers to; NULL: no files
} FlSurveyFrame;

void fl_survey_frame_clear(FlSurveyFrame *frame);

/** A leaf as it is measured on a page of its own. */
typedef struct FlShape {
    uint64_t paint; // hash of its keys; as wide as the rest, so that no byte of a shape is unset
    double x, y, width, height;
} FlShape;

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlStrings, fl_strings_clear)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlSurveyFrame, fl_survey_frame_clear)
