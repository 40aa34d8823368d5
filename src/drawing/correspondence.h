/* The leaves of two frames, matched, and the motion of their outlines. */
#pragma once

#include "drawing/outlines.h"
#include "svg/geometry.h"

typedef enum FlMotionKind {
    FL_MOTION_NONE,       // unknown: not parsed, or a jump
    FL_MOTION_NEW,        // it has appeared or grown: what was there before has not moved
    FL_MOTION_STILL,      // its outline is where it was
    FL_MOTION_AFFINE,     // one map took all of it here
    FL_MOTION_SAME,       // segment by segment
    FL_MOTION_REGISTERED, // there before, in another structure: only masks can show the motion
} FlMotionKind;

typedef struct FlLeafMotion {
    int before; // index of the leaf in the frame before; -1: not paired
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

/** Two frames of a drawing; `before` need not be the previous one. */
typedef struct FlTwoFrames {
    const FlOutlines *before, *now;
    const FlLeafFill *before_fill, *now_fill;
    double side; // the frame's larger side, px
} FlTwoFrames;

/**
 * Pairs the leaves that have the same number in their region, see FlLeafFill.nth, and finds how
 * each moved. A leaf that moves by more than half its size and a twentieth of the frame has no
 * known motion unless its structure is the same, and its name or its region, in which it is alone.
 *
 * The rotation of a round leaf is that of the leaves of its group inside it, if there are any.
 */
FlCorrespondence *fl_correspond(const FlTwoFrames *frames);

void fl_correspondence_free(FlCorrespondence *correspondence); // NULL is fine

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlCorrespondence, fl_correspondence_free)

/** Points of a leaf in both frames, px, at the same parameters. */
typedef struct FlSamples {
    int n;
    FlPoint *before, *now;
} FlSamples;

/** shift is by subpath of b, as in FlCorrespondence; a and b have the same structure. */
void fl_samples_take(FlSamples *samples, const FlOutlines *before, const FlGeometry *a,
                     const FlOutlines *now, const FlGeometry *b, const int32_t *shift);

void fl_samples_clear(FlSamples *samples);

/** The place of a segment's point in the frame before, px; sub and cubic are that frame's. */
FlPoint fl_same_point(const FlSubpath *sub, const FlCubic *cubic, const FlAffine *ctm, int shift,
                      int segment, double t);

double fl_distance2(FlPoint a, FlPoint b);
FlPoint fl_mean_point(const FlPoint *p, int n);

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlSamples, fl_samples_clear)

typedef struct FlLeafMeasure {
    double x0, y0, x1, y1; // box of its outline, px; empty: x1 < x0
} FlLeafMeasure;

/** Gives round leaves that rest, move or grow the turn of two or more leaves of their group that
 * lie inside them in both frames, if these agree to half a pixel. */
void fl_turn_round_hosts(const FlTwoFrames *frames, const FlLeafMeasure *before,
                         const FlLeafMeasure *now, FlCorrespondence *correspondence);
