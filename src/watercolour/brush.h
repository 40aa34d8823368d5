/* Brush strokes: the events of a recipe, which add water and pigment to the sheet. */
#pragma once

#include "watercolour/sheet.h"

/** The effect of an event on one cell. */
typedef struct FlTouch {
    float inside;                // depth of its centre inside the stroke's first outline, px
    float away;                  // distance from the line that the brush follows, px
    float load;                  // factor on the pigment, 1 on the average
    float bristle;               // density of the bristles, 0 on the average
    float play[FL_MAX_PIGMENTS]; // factors on single pigments, 1 on the average
} FlTouch;

FlTouch fl_brush_touch(const FlEvent *event, uint64_t key, float x_px, float y_px);

/** The events of a recipe with their FlTouch for every cell. */
typedef struct FlBrush FlBrush;

/** Returns: NULL with FL_ERROR_NO_MEMORY set. The recipe must outlive the brush. */
FlBrush *fl_brush_new(const FlRecipe *recipe, GError **error);

void fl_brush_free(FlBrush *brush); // NULL is fine

/** Does one step of all events that are active between two times, in frames. */
void fl_brush_apply(const FlBrush *brush, FlSheet *sheet, float before, float after);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlBrush, fl_brush_free)
