/* The stored planes of a guide sequence, for the code that builds them and the code that reads. */
#pragma once

#include "base/spill.h"
#include "guides/guides.h"
#include "guides/outline.h"

/** The stored planes of a frame, cropped to its box. */
typedef enum FlGuidePlane {
    FL_GUIDE_PLANE_COVERAGE_ANGLE, // coverages, then angles; bytes
    FL_GUIDE_PLANE_FLOW,           // interleaved, FL_FLOW_ONE a px
    FL_GUIDE_PLANE_PLUS,           // FL_EXTENT_ONE a px, as is MINUS
    FL_GUIDE_PLANE_MINUS,
    FL_GUIDE_PLANE_MOTION, // interleaved, FL_MOTION_ONE a px
    FL_N_GUIDE_PLANES,
} FlGuidePlane;

/** A frame that looks like the one before shares its blocks. */
typedef struct FlFrameRecord {
    FlRect box;
    bool empty;                        // no pixel inside
    bool rests;                        // no change since the frame before
    bool unknown;                      // the drawing's motion into it is known nowhere
    int32_t holder[FL_N_GUIDE_PLANES]; // the frame whose block holds the plane; -1: all 0
} FlFrameRecord;

struct FlGuideSequence {
    FlGuideSource source;
    FlGuideParams params;
    FlFrameRecord *frames; // source.n_frames
    FlSpill *spill;        // block of a plane of a frame: FL_N_GUIDE_PLANES * frame + plane
};

static inline size_t fl_guide_plane_block(int frame, FlGuidePlane plane)
{
    return (size_t)frame * FL_N_GUIDE_PLANES + plane;
}

/** The number of integers per pixel of a plane. */
static inline size_t fl_plane_step(FlGuidePlane plane)
{
    return plane == FL_GUIDE_PLANE_FLOW || plane == FL_GUIDE_PLANE_MOTION ? 2 : 1;
}

/** Reads a stored plane, of bytes or integers; a holder of -1 is not stored. */
bool fl_guide_sequence_shape(const FlGuideSequence *sequence, int frame, uint8_t *coverage_angle,
                             GError **error);
bool fl_guide_sequence_plane(const FlGuideSequence *sequence, int frame, FlGuidePlane plane,
                             int32_t *values, GError **error);

/* ---- in build_guides.c ---- */

/** Reads the masks and fills sequence->frames and spill, forwards, all but the extents to come. */
bool fl_guide_sequence_build(FlGuideSequence *sequence, GError **error);
