/* A frame as pictures: what is drawn of each region, from the bottom up. */
#pragma once

#include "base/page.h"
#include "base/rect.h"
#include "params/region_settings.h"
#include "svg/svg_frame.h"
#include <fluidy/error.h>

/** One part of a leaf, as it is drawn in one frame. 36 bytes, once per step and frame. */
typedef struct FlDrawStep {
    int32_t leaf;   // index of the leaf; of a unit -1 - its index
    int16_t region; // index of its region
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

/**
 * One entry of a frame's draw list, from the bottom up: leaves of one region that can be drawn
 * together. A region that lies both below and above another has several draws in a frame, and so
 * has one whose leaves differ in colour. A draw composites colour `rgb`, or that of `picture`, with
 * opacity coverage * alpha / 255; regions that are not paintable are drawn just so.
 */
typedef struct FlDraw {
    int region;        // index of its region
    FlArea area;       // its place in the frame
    uint8_t *coverage; // of the area's box, 0..255: the whole shape, hidden parts included
    uint8_t *by_hand;  // of the box: coverage that a hand leaves; NULL: all
    uint8_t *picture;  // of the box, 4 bytes a pixel, straight sRGBA as the SVG draws it; NULL:
                       // flat `rgb`. A is coverage again, colours are defined where A > 0
    uint8_t rgb[3];    // the fill; of a picture its mean
    uint8_t alpha;     // opacity of the draw, 255 opaque; not part of coverage
    FlBlendMode blend_mode; // with the draws below
} FlDraw;

typedef struct FlDrawList {
    int n;
    FlDraw *draw;
} FlDrawList;

/** The hand that draws what is not painted of a region. */
typedef struct FlRegionHand {
    FlLine line;
    int boil; // frames until it draws anew; 0: never
} FlRegionHand;

/** The drawing of regions that are not painted; see worker/hand_line.h. */
typedef struct FlHand {
    const FlRegionHand *of_region; // of each; borrowed
    uint64_t seed;
    float page;    // px of the picture per px of the page, see base/page.h
    FlTooth tooth; // of the frame's paper
} FlHand;

/** True if the hand draws any of the n steps; NULL: no hand. */
bool fl_steps_need_hand(const FlDrawStep *step, int n, const FlHand *hand);

void fl_draw_clear(FlDraw *draw);
void fl_draw_list_free(FlDrawList *draws); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlDrawList, fl_draw_list_free)
