/* Where anything stirs between two frames of a mask: it changes, flows or moves. */
#ifndef FLUIDY_GUIDES_STIRRING_H
#define FLUIDY_GUIDES_STIRRING_H

#include "guides/outline.h"

/** By squares of FL_REST_PX px, row by row: FL_REST_TAKEN, FL_REST_STIRS. */
typedef struct FlStirring {
    int columns, rows;
    uint8_t *square;
    bool any; // square stirs
} FlStirring;

/** Of frames of width * height px, in which nothing stirs so far. FL_ERROR_NO_MEMORY. */
bool fl_stirring_init(FlStirring *stirring, int width, int height, GError **error);
void fl_stirring_clear(FlStirring *stirring);

/** Forgets what it has of a pair of frames. */
void fl_stirring_reset(FlStirring *stirring);

/** Marks where the coverage differs. */
void fl_stirring_mark_change(FlStirring *stirring, const FlOutline *before, const FlOutline *now);

/** Marks where the flow inside is faster than still_px; flow: of the box, FL_FLOW_ONE a px. */
void fl_stirring_mark_flow(FlStirring *stirring, const FlOutline *now, const int32_t *flow,
                           float still_px);

/** Marks where a motion is known that is not 0, however slow it is, since it is seen after some
 * frames. motion: of the box, fl_motion_to_fixed(). */
void fl_stirring_mark_motion(FlStirring *stirring, const FlOutline *now, const int32_t *motion);

/** Marks what an outline takes. */
void fl_stirring_mark_taken(FlStirring *stirring, const FlOutline *outline);

static inline size_t fl_stirring_squares(const FlStirring *stirring)
{
    return (size_t)stirring->columns * (size_t)stirring->rows;
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlStirring, fl_stirring_clear)

#endif
