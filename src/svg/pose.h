/* The pose of an outline: where it is and how it is turned, to be compared with that of another
 * frame. */
#pragma once

#include "svg/geometry.h"

#define FL_POSE_MOST_PX 1e6f // of all that a pose says

/** Of the nodes of an outline, px of the picture, on the page or not. */
typedef struct FlPose {
    int32_t n;                // nodes; 0: the pose is unknown
    float start_x, start_y;   // the first one
    float x, y;               // their mean
    float middle_x, middle_y; // of what the outline encloses, whatever its nodes are
    float spread[3];          // variances along x and y of what it encloses, their covariance, px^2
    float harmonic[2][2];     // the first and the last one of the nodes about their mean, in their
                              // order, as real and imaginary part: both turn with the outline
} FlPose;

/** Of leaf `leaf`, or of all leaves of unit -1 - leaf. */
FlPose fl_outline_pose(const FlOutlines *outlines, int leaf);

/** Returns: true if all of it is within FL_POSE_MOST_PX, as in poses that these functions give. */
bool fl_pose_is_sound(const FlPose *pose);

/** Of something that is known to be at a point. */
FlPose fl_point_pose(FlPoint point);
