/* The wet paper of a film: which regions mark it in each frame, and how it dries. */
#ifndef FLUIDY_WET_WET_H
#define FLUIDY_WET_WET_H

#include "compose/compose_input.h"
#include "job/plan.h"

/** Frames after which no mark is left: so many before it starts a part of a film has to know. */
#define FL_WET_FRAMES 36

typedef struct FlWet FlWet;

/** Writes the drawing's motion of a region into a frame, as fl_motion_source_get() does. */
typedef bool (*FlWetMotion)(void *data, int region, int before, int now, FlRect part, float *motion,
                            GError **error);

/** Whether any region of the plan marks the paper. */
bool fl_wet_wanted(const FlPlan *plan);

/** The plan is borrowed, and its masks are rasterised. paper: on which paint is thought to lie. */
FlWet *fl_wet_new(const FlPlan *plan, const uint8_t paper[3], FlWetMotion motion, void *data,
                  GError **error);
void fl_wet_free(FlWet *wet); // NULL is fine

/**
 * Goes on to a frame: the one after that of the last call, or any as the first one. Before that the
 * paper is known from FL_WET_FRAMES frames of masks, motion and fills.
 */
bool fl_wet_frame(FlWet *wet, int frame, GError **error);

/** The marks of the frame as a layer, and where its paint is noted for the next one. */
const FlStainLayer *fl_wet_layer(const FlWet *wet);
FlLaid *fl_wet_laid(FlWet *wet);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlWet, fl_wet_free)

#endif
