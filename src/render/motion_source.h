/* The source of the regions' exact motion: the outlines of the film's frames. */
#pragma once

#include "cover/mask_store.h"
#include "guides/motion.h"

/**
 * A film's outlines: those of the frames asked for last are in memory, those read before in a
 * temporary file. Any thread may ask.
 */
typedef struct FlMotionSource FlMotionSource;

/** film and masks must stay; masks are filled when motion is asked for. halved: motion is that of
 * frames of half the size. FL_ERROR_OUTPUT. */
FlMotionSource *fl_motion_source_new(const FlDrawing *drawing, const FlMaskStore *masks,
                                     bool halved, GError **error);
void fl_motion_source_free(FlMotionSource *source); // NULL is fine

/** A region from one frame to another, within a part of them. */
typedef struct FlRegionStep {
    int region, before, now;
    FlRect rect;            // px of the drawing
    FlOutlinePair outlines; // of its masks in rect, where they are known; halved as the motion is
    const float *fluid;     // see FlMovingRegion
    float wetness;
} FlRegionStep;

/**
 * The motion of a region from the frame painted before to this one, px, interleaved, 2 * area of
 * rect, or of fl_rect_halved(rect): see fl_motion_of_region(). The frames need not be neighbours,
 * and in a loop the first follows the last. All 0 if the region is in one of them only; shares may
 * be NULL.
 *
 * Returns: false with an error that names the file, or FL_ERROR_NO_MEMORY.
 */
bool fl_motion_source_get(FlMotionSource *source, const FlRegionStep *step, float *motion,
                          FlMotionShares *shares, GError **error);

/** fl_motion_source_get() of a halved source in whole px: 2 * area of rect. source: an
 * FlMotionSource. */
bool fl_motion_source_whole(void *source, int region, int before, int now, FlRect rect,
                            float *motion, GError **error);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlMotionSource, fl_motion_source_free)
