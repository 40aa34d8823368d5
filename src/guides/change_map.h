/* The changes between two frames of a mask: its coverage, or where it flows or moves. */
#ifndef FLUIDY_GUIDES_CHANGE_MAP_H
#define FLUIDY_GUIDES_CHANGE_MAP_H

#include "guides/outline.h"

/** By squares of FL_REST_PX px, row by row: FL_SQUARE_TAKEN, FL_SQUARE_CHANGES. */
typedef struct FlChangeMap {
    int columns, rows;
    uint8_t *square;
    bool any; // square changes
} FlChangeMap;

/** Makes an empty map of frames of width * height px. FL_ERROR_NO_MEMORY. */
bool fl_change_map_init(FlChangeMap *changes, int width, int height, GError **error);
void fl_change_map_clear(FlChangeMap *changes);

/** Empties the map for the next pair of frames. */
void fl_change_map_reset(FlChangeMap *changes);

/** Marks where the coverage differs. */
void fl_change_map_mark_change(FlChangeMap *changes, const FlOutline *before, const FlOutline *now);

/** Marks where the flow inside is faster than still_px; flow: of the box, FL_FLOW_ONE a px. */
void fl_change_map_mark_flow(FlChangeMap *changes, const FlOutline *now, const int32_t *flow,
                             float still_px);

/** Marks where a motion is known that is not 0, however slow it is, since it is seen after some
 * frames. motion: of the box, fl_motion_to_fixed(). */
void fl_change_map_mark_motion(FlChangeMap *changes, const FlOutline *now, const int32_t *motion);

/** Marks what an outline takes. */
void fl_change_map_mark_taken(FlChangeMap *changes, const FlOutline *outline);

static inline size_t fl_change_map_squares(const FlChangeMap *changes)
{
    return (size_t)changes->columns * (size_t)changes->rows;
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlChangeMap, fl_change_map_clear)

#endif
