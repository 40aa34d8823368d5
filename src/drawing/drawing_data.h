/* The data of an FlDrawing; private to drawing/. */
#ifndef FLUIDY_DRAWING_DRAWING_DATA_H
#define FLUIDY_DRAWING_DRAWING_DATA_H

#include "base/frame_cache.h"
#include "drawing/drawing.h"
#include "svg/geometry.h"

/** How one part of a leaf is drawn in one frame. 36 bytes: this is what grows with the number of
 * frames. */
typedef struct FlDrawStep {
    int32_t leaf;   // index of the leaf; of a unit -1 - its index
    int16_t region; // index into the drawing's regions
    uint8_t part;   // FlPart
    uint8_t flat;   // else drawn as a picture
    uint8_t rgb[3];
    uint8_t alpha;      // of its draw
    uint8_t drawn;      // FlSvgPaint.peak: the opacity drawn at full coverage
    uint8_t blend_mode; // FlBlendMode
    uint16_t nth;       // FlSurveyPart.nth
    float width;        // FlSurveyPart.width
    float box[4];       // x0, y0, x1, y1 that it lies in, px
} FlDrawStep;

typedef struct FlDrawingFrame {
    int n;
    FlDrawStep *step; // bottom up
    FlPageSize page;  // px of the picture
    FlCanvas canvas;  // as in FlSvgOptions
    char **whole;     // likewise
    FlAnchor *anchor; // of each region
    int origin;       // its index when the drawing was opened
} FlDrawingFrame;

void fl_drawing_frame_clear(FlDrawingFrame *frame);

/** fl_drawing_draw_by_hand() in this process. */
FlDrawList *fl_draw_list_make(const FlDrawing *drawing, int frame, const FlHand *hand,
                              FlFrameCache *cache, GError **error);

/** Whether a hand, NULL: none, draws anything in a frame. */
bool fl_frame_is_by_hand(const FlDrawingFrame *frame, const FlHand *hand);

/** fl_drawing_outlines() in this process. */
FlOutlines *fl_outlines_make(const FlDrawing *drawing, int frame, GError **error);

struct FlDrawing {
    FlSequence *sequence;
    double dpi;
    int width, height;
    int n_halved;            // how often fl_drawing_halve() was called
    struct FlDrawPool *pool; // draws the frames; NULL: this process does
    FlDrawingFrame *frame;
    GArray *regions;   // FlRegion
    GHashTable *files; // real paths of what the drawings refer to
};

#endif
