/* The state of a region between two frames, as bytes, for a later render that resumes. */
#pragma once

#include "synth/nnf.h"

#define FL_SYNTH_STATE_HEADER 28 /**< bytes before those that are packed */

/** The state that the next frame of a region needs from the frames before. */
typedef struct FlSynthState {
    int width, height;                 // of the frame
    int painted_width, painted_height; // of its picture: the same, or larger
    int frame;                         // frames painted so far, >= 0
    bool valid;                        // the last of them had paint; else the rest is undefined
    FlRect rect;                       // its part of the frame
    FlNnf nnf;                         // its level-0 field, as large as rect
    uint8_t *mask;                     // fl_rest_shape() of the whole frame, width * height
    uint8_t *wet;                      // fl_drying_step() of the whole frame, width * height
    bool dries;                        // true if drying goes on at rest
    uint8_t *rgb; // the picture of the whole frame, painted_width * painted_height * 3
} FlSynthState;

/** The bytes of the picture. */
static inline size_t fl_synth_state_painted(const FlSynthState *state)
{
    return 3 * (size_t)state->painted_width * (size_t)state->painted_height;
}

/** Frees the planes: field, mask, wetness and picture, so that there was no paint. The rest stays.
 */
void fl_synth_state_clear(FlSynthState *state);

/** Packed, in this machine's byte order. Returns: NULL with FL_ERROR_NO_MEMORY set. */
GBytes *fl_synth_state_pack(const FlSynthState *state, GError **error);

/**
 * The reverse, for an exemplar whose level 0 is `level`, into a state of the same sizes, whose
 * planes are freed. The bytes need not be trusted: a field that points outside the exemplar is an
 * error.
 *
 * Returns: false with FL_ERROR_CHANGED or FL_ERROR_NO_MEMORY set; the planes are then cleared.
 */
bool fl_synth_state_unpack(FlSynthState *state, GBytes *bytes, const FlExemplarLevel *level,
                           GError **error);
