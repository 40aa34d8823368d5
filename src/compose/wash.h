/* Washes: the light and shadow side, brush passes, drying lines, pools and blooms that wet paint
 * leaves in a shape as a hand fills it, and the balance of its two pigments. */
#pragma once

#include "compose/compose_input.h"

/** The slow fields from which a wash is computed. */
typedef enum FlWashPlane {
    FL_WASH_TONE,   // ln of the amount: light and shadow side, pools
    FL_WASH_HUE,    // balance of the pigments, without lines
    FL_WASH_PASS,   // place across the brush: each whole number is a pass
    FL_WASH_DRY,    // -1..1: of the brush; where it is dry, edges are found
    FL_WASH_LINES,  // strength of passes, 0..1
    FL_WASH_FRONT,  // distance from where water stopped, px of the page; below 0 it was flooded
    FL_WASH_FRONTS, // strength of fronts, 0..2
    FL_WASH_X,      // place in the shape, px of the page, drawn out across fronts
    FL_WASH_Y,
    FL_WASH_ROUGH, // strength of ragged ends, ln of the amount
    FL_WASH_CALM,  // share of the recording's unevenness that is lost, 0..1
    FL_WASH_PLANES,
} FlWashPlane;

/** The wash of all shapes of one fill in a frame: they are filled in one go, so that where they
 * touch it is one. */
typedef struct FlWash {
    const FlPaintedRegion *painted; // the first of its regions; borrowed
    FlWashStyle style;              // its strengths
    uint64_t key;                   // of the film's seed and the fill
    float brush_px;                 // width of a pass, px of the page
    float along[2];                 // vector along the passes
    FlRect box;                     // px of the frame
    int step;                       // px of the frame from point to point
    int width, height;              // points; the first is at the corner of the box
    float *plane[FL_WASH_PLANES];   // of width * height
} FlWash;

/** The washes of a frame. */
typedef struct FlWashes {
    int n;
    FlWash *wash;
    int *of_draw; // the index of each draw's wash; -1: it has none
} FlWashes;

/**
 * Finds the washes of a frame. They depend only on its shapes, whole as if no other shape lay over
 * them, and on the motion of each since it was first seen.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_washes_find(FlWashes *washes, const FlComposeInput *input, const FlDrawList *draws,
                    GError **error);
void fl_washes_clear(FlWashes *washes);

/** The wash of a draw; NULL: it has none. */
static inline const FlWash *fl_wash_of_draw(const FlWashes *washes, int draw)
{
    return washes->of_draw[draw] >= 0 ? &washes->wash[washes->of_draw[draw]] : NULL;
}

/** The strengths of the wash of a painted region: those of its settings, else its style's. */
FlWashStyle fl_wash_style_of(const FlPaintedRegion *painted);

/** The share by which a fill is white as bare paper, 0..1. */
float fl_whiteness(const uint8_t fill[3], const uint8_t paper[3]);

/** The ln of the factor on amounts and the balance of the pigments at each point of a wash of
 * strength 1. */
void fl_wash_find_tones(const FlWash *wash, float *tones, float *hues);

#define FL_PLAY_ONE 64 // of the balance of two pigments

/**
 * Lays a wash over the amounts of paint of an area. white 0..1 is the share by which the paint is
 * bare paper with a shadow: amounts are even, and the play is the shadow.
 *
 * play, of the box as amounts are, becomes the balance of two pigments: -2 to below 2, in 1 /
 * FL_PLAY_ONE; where amounts are below 0 it is undefined.
 */
void fl_wash_lay(const FlWash *wash, float white, const FlArea *area, int16_t *amounts,
                 int8_t *play);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlWashes, fl_washes_clear)
