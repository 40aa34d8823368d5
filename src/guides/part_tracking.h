/* Tracks the parts of a shape to another frame. */
#pragma once

#include "guides/outline.h"

typedef enum FlTraceKind {
    FL_TRACE_LOST,     // no part of the other frame matches
    FL_TRACE_OVERLAPS, // a pixel of it is inside in both frames: its contour tells the motion
    FL_TRACE_JUMPS,    // it moved by more than its own size
} FlTraceKind;

/** The relation of one part of a frame's shape to another frame. */
typedef struct FlTrace {
    FlTraceKind kind;
    float offset[2]; // of its centre, from the part that it jumps from or that it overlaps, if they
                     // are alike in size, px
} FlTrace;

/**
 * Looks for the parts of `now` in the other frame, which may be NULL or empty. One that no pixel of
 * the other frame overlaps is taken to come from the nearest part there that no pixel of `now`
 * overlaps, if that is between half and twice its size, and its centre at most limit_px away.
 *
 * trace is an array of now->parts.n_parts + 1 by part number.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_part_tracking_find(const FlOutline *now, const FlOutline *other, float limit_px,
                           FlTrace *trace, GError **error);
