/* Which leaf was which a frame before, and how its outline got from there to here. */
#ifndef FLUIDY_DRAWING_CORRESPONDENCE_H
#define FLUIDY_DRAWING_CORRESPONDENCE_H

#include "drawing/outlines.h"

typedef enum FlMotionKind {
    FL_MOTION_NONE,       // nothing is known: not understood, or a jump
    FL_MOTION_NEW,        // it has entered, or grown: what is there now was there or was not
    FL_MOTION_STILL,      // its outline is where it was
    FL_MOTION_AFFINE,     // one map took all of it here
    FL_MOTION_SAME,       // segment by segment
    FL_MOTION_REGISTERED, // there before, in another structure: only masks can tell
} FlMotionKind;

typedef struct FlLeafMotion {
    int before; // index of the leaf in the frame before; -1: none
    FlMotionKind kind;
    FlAffine back; // AFFINE: from px of this frame to px of the one before
} FlLeafMotion;

/** All leaves of a frame. */
typedef struct FlCorrespondence {
    int n;
    FlLeafMotion *leaf;
    /**
     * By subpath of this frame, where kind is SAME: which segment of the subpath before is its
     * first; -1 - that if it was drawn the other way round.
     */
    int32_t *shift;
} FlCorrespondence;

/** What is compared; both frames are of one film, `before` need not be the one before `now`. */
typedef struct FlTwoFrames {
    const FlOutlines *before, *now;
    const FlLeafLook *before_look, *now_look;
    double side; // the frame's larger side, px
} FlTwoFrames;

/**
 * Pairs the leaves within each region, in paint order as far as there is one, by id, labels, paint,
 * structure, place and size, and finds how each moved. A leaf that moves by more than half its size
 * and a twentieth of the frame is only believed if its structure and its name are the same.
 *
 * A round leaf shows no turning of its own; if leaves of its group lie inside it, they tell.
 */
FlCorrespondence *fl_correspond(const FlTwoFrames *frames);

void fl_correspondence_free(FlCorrespondence *correspondence); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlCorrespondence, fl_correspondence_free)

#endif
