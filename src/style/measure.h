/* Measurements of a style: how much paint it has, how that moves, how rich its texture is. */
#pragma once

#include "guides/guides.h"
#include "style/style_folder.h"

/** Slower paint rests; paint of FL_MOVING_PX and more moves; px per frame. */
#define FL_RESTING_PX 0.25f
#define FL_MOVING_PX 0.5f
#define FL_TOO_FAST_PX 4.0f // a faster front cannot be followed by 5x5 patches

/** One frame. Shares are 0..1. */
typedef struct FlFrameMeasure {
    float paint;    // share of the frame inside the mask
    float interior; // of the paint: deeper than the border
    float resting;  // of the paint: slower than FL_RESTING_PX
    float moving;   // of the paint: FL_MOVING_PX or faster
    float front;    // median speed of the outline, px per frame
    float steady;   // of the outline: from FL_MOVING_PX to FL_TOO_FAST_PX
    float paper;    // median lightness of the bare paper, levels; -1: no bare paper
    float change;   // mean change of painted pixels' lightness to the next frame, levels; the last
                    // frame repeats the value before
} FlFrameMeasure;

enum { FL_SPEED_BINS = 24, FL_OCTANTS = 8 };

typedef struct FlMeasures {
    int n_frames;
    FlFrameMeasure *frame;
    float speed[FL_SPEED_BINS]; // share of all paint by speed, 0.25 px per frame each; last: more
    float
        orientation[FL_OCTANTS]; // share of all outline by outward direction: right, down right, …
    float rim[4];                // share of the left, top, right, bottom rim in the mask, at most
    float texture;               // fine detail of the interior, levels (RMS above 2 px blur)
    float thin_texture;          // the same where paint is a tenth to half as dense; -1: nowhere
    float paper_texture;         // the same of bare paper; -1: no bare paper
    float alike;       // RMS difference of the two most similar 16x16 blocks; -1: fewer than two
    int n_blocks;      // 16x16 blocks of paint in the last frame
    float paper_range; // range of the light on the bare paper, levels
    float edge;        // density at the outline as a share of the interior's
} FlMeasures;

/** Measures a style. NULL with FL_ERROR_NO_MEMORY or an error of the guides set. */
FlMeasures *fl_measure(const FlStyle *style, const FlGuideSequence *sequence, GError **error);

/** Compares two floats, for sorting. */
int fl_compare_floats(const void *a, const void *b);

void fl_measures_free(FlMeasures *measures); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlMeasures, fl_measures_free)

/* ---- the sheet of fluidy-style check --------------------------------------------------------- */

/** The content of a sheet; all of it belongs to the caller. */
typedef struct FlCheckSheet {
    const FlStyle *style;
    const FlMeasures *measures;
    const FlGuideSequence *guides;
    const GPtrArray *facts;    // (element-type char*) lines
    const GPtrArray *problems; // (element-type char*) lines
} FlCheckSheet;

/**
 * Draws frames with mask outline and border, the flow as arrows, histograms, facts and problems
 * into a PNG file. Returns: false with FL_ERROR_OUTPUT, FL_ERROR_NO_MEMORY, FL_ERROR_LIMIT or
 * an error of the guides set.
 */
bool fl_check_sheet_write(const FlCheckSheet *sheet, const char *path, GError **error);
