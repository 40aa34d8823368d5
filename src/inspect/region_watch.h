/* Changes, motion and sources of the paint of a region, for the page of a report. */
#pragma once

#include "base/rect.h"
#include "compose/painted_region.h"
#include "guides/guides.h"

/** The last frame of a region, in the size of its rect, for the change of paint that stays inside
 * it. */
typedef struct FlFlicker {
    uint8_t *luma, *mask; // NULL: no frame yet
    int16_t *motion;      // x, y: px to the next frame
    double change;        // of the last frame, see fl_flicker_measure()
} FlFlicker;

void fl_flicker_clear(FlFlicker *flicker);

/**
 * Compares the picture just painted with the one before, in the style's colours, along the flow.
 * guides are the new frame's.
 *
 * Sets flicker->change to the mean absolute difference of luma, in levels of 255, over the pixels
 * that lie in the region before and after; NAN without such pixels. Errors: FL_ERROR_NO_MEMORY.
 */
bool fl_flicker_measure(FlFlicker *flicker, const FlPaintedRegion *painted, const FlGuides *guides,
                        GError **error);

/** The same of the exemplar, without motion: mean over its frames; NAN if it has only one. */
double fl_flicker_of_exemplar(const FlExemplar *exemplar);

/* ---- a point that moves as the drawing does, for slices through time ------------------------- */

/** The position of the point in a frame. */
typedef struct FlFollowedPoint {
    bool here;  // the region is in the frame, else the other fields are undefined
    bool found; // placed anew since the caller last cleared this flag: no motion led here
    float x, y; // px of the guides, in the frame
    float turn; // of the drawing around it since it was found, turns, clockwise
} FlFollowedPoint;

/**
 * Moves the point into the next painted frame, whose guides of `rect` these are: along the
 * drawing's motion where that is known, else along the flow. A point that was absent, or from which
 * no pixel came, is placed at the deepest pixel of the region.
 */
void fl_followed_point_move(FlFollowedPoint *point, FlRect rect, const FlGuides *guides);

/* ---- the use of each part of a recording: repeats show as bright spots ----------------------- */

/** Counts of the matches in one recording. */
typedef struct FlExemplarUse {
    const FlStyleInstance *style; // borrowed; NULL: unused
    uint32_t *place;              // exemplar's width * height: matches, over all its frames
    uint32_t *frame;              // n_frames: matches
    uint64_t total;
} FlExemplarUse;

/** Starts the counts of a recording at 0. FL_ERROR_NO_MEMORY. */
bool fl_exemplar_use_init(FlExemplarUse *use, const FlStyleInstance *style, GError **error);
void fl_exemplar_use_clear(FlExemplarUse *use);

/** Counts the matches of a region painted from use->style; a region without a view has no matches.
 */
void fl_exemplar_use_add(FlExemplarUse *use, const FlPaintedRegion *painted);

/**
 * Appends {"style": name, "picture": …, "frames": [share, …]}: the use of each place over the
 * recording in grey, of each frame as a share of all. FL_ERROR_NO_MEMORY.
 */
bool fl_exemplar_use_write(const FlExemplarUse *use, GString *json, GError **error);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlExemplarUse, fl_exemplar_use_clear)
