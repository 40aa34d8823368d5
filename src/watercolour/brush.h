/* What is done to the sheet from outside: strokes that give water and pigment for a while. */
#ifndef FLUIDY_WATERCOLOUR_BRUSH_H
#define FLUIDY_WATERCOLOUR_BRUSH_H

#include "watercolour/sheet.h"

/** What an event does to one cell. */
typedef struct FlTouch {
    float inside; // how far inside the stroke's first outline its centre lies, px
    float away;   // how far from the line that the brush follows, px
    float load;   // factor on the pigment, 1 on the average
} FlTouch;

FlTouch fl_brush_touch(const FlEvent *event, uint64_t key, float x_px, float y_px);

/** The events of a recipe with their footprints worked out. */
typedef struct FlBrush FlBrush;

/** Returns: NULL with FL_ERROR_NO_MEMORY set. The recipe must outlive the brush. */
FlBrush *fl_brush_new(const FlRecipe *recipe, GError **error);

void fl_brush_free(FlBrush *brush); // NULL is fine

/** Does one step of all events that are active between the times before and after, in frames. */
void fl_brush_apply(const FlBrush *brush, FlSheet *sheet, float before, float after);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlBrush, fl_brush_free)

#endif
