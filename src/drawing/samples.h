/* Corresponding points of two outlines of one structure. */
#ifndef FLUIDY_DRAWING_SAMPLES_H
#define FLUIDY_DRAWING_SAMPLES_H

#include "svg/geometry.h"

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

#endif
