/* One pass over the drawing: the parts of every frame, where they are, and with which paint. */
#ifndef FLUIDY_DRAWING_SURVEY_H
#define FLUIDY_DRAWING_SURVEY_H

#include "drawing/drawing.h"
#include "svg/pose.h"

#define FL_SURVEY_MOST_SIDE 32767 // px; cairo's limit

/** Strings as numbers, so that they are kept once and compared fast. 0 is "". */
typedef struct FlStrings {
    GPtrArray *text;
    GHashTable *number;
} FlStrings;

int fl_strings_add(FlStrings *strings, const char *text);
const char *fl_strings_get(const FlStrings *strings, int number);

/** A part of a leaf, or a unit, in one frame. Strings are numbers in FlSurvey.strings. */
typedef struct FlSurveyPart {
    int leaf; // index of the leaf; of a unit -1 - its index
    FlPart part;
    bool stroke;
    bool has_fill, has_stroke; // of the leaf it is a part of
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
    int nth;       // set later: the first, second, … leaf that the region has in the film
} FlSurveyPart;

typedef struct FlSurveyFrame {
    GArray *parts;   // FlSurveyPart, bottom up
    FlPageSize page; // px of the picture
    FlCanvas canvas; // the frame's page
    char **whole;    // FlSvgOptions.whole; NULL: none
    int n_nameless;  // groups without an id
    char **files;    // that it refers to; NULL: none
} FlSurveyFrame;

typedef struct FlSurvey {
    const FlSequence *sequence;
    FlSvgOptions svg;
    FlStrings strings;
    int width, height; // of the picture, px
    FlPageSize page;   // of the first frame, px of the picture
    double scale;      // px of the picture per px of the drawing
    int n_frames;
    FlSurveyFrame *frame;
    struct FlFrameCache *cache; // of each thread
    FlSvg *first;          // the first frame, opened for its size and not probed yet; else NULL
    struct FlWatch *watch; // records what is being read; may be NULL
} FlSurvey;

/**
 * Reads every frame. `watch`, see drawing/watch.h, and warnings may be NULL.
 * Returns: false with an error, which names the file.
 */
bool fl_survey_init(FlSurvey *survey, const FlSequence *sequence, const FlDrawingOptions *options,
                    struct FlWatch *watch, FlWarnings *warnings, GError **error);

/**
 * Decides between units and their leaves, which fl_survey_init() both lists: a group that is drawn
 * leaf by leaf in other frames, because it only fades for a while, is so in all; another stays one.
 */
void fl_survey_choose_units(FlSurvey *survey);

void fl_survey_clear(FlSurvey *survey);

#endif
