/* The guides of a mask sequence: distance, flow, direction and extents of motion [F21 §3.1–3.3]. */
#pragma once

#include "guides/distance.h"
#include "guides/outline.h"
#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

/** Parameters of the guides; every length is in level-0 pixels. */
typedef struct FlGuideParams {
    float flow_sigma_frames; // temporal Gaussian on the flow, cut at 3 sigma [F21 App. A]; 0: off
    float
        dist_sigma_frames; // temporal Gaussian on the distance, the thesis' way [P21 §4.1]; 0: off
    float still_px;        // slower than this the direction is the outward normal's; px/frame
    float flow_limit;      // a contour moves at most this share of the larger side in one frame
    float dist_sigma_px; // spatial Gaussian on the distance that flow is made from [P21 §4.1]; 0:
                         // none
} FlGuideParams;

/**
 * The guides of one frame. All planes are row-major, width * height, without padding.
 *
 * Directions are angles of 256 steps a turn, 0 along +x, 64 along +y (down), and are defined inside
 * the mask, still pixels included. Flow, angle and extents are 0 outside the mask.
 */
typedef struct FlGuides {
    int width, height;
    bool disposable;  // not read after the engine, which may clear them before it paints
    bool blank;       // flow, extents and motion are 0 all over, as fl_guides_init() leaves them
    uint8_t *mask;    // coverage 0..255; a pixel is inside from FL_INSIDE on
    float *distance;  // signed distance to the contour, px, positive inside, everywhere defined
    float *depth;     // depth used by the synthesis, from fl_rim_depth(); before that, the distance
    float *flow;      // interleaved u, v: px per frame, 2 * width * height
    uint8_t *angle;   // direction of the flow
    float *ext_plus;  // |sum of the flow since the pixel was last outside the mask|, px
    float *ext_minus; // the same, summed from the end of the sequence
    uint8_t *bare;    // share of the surroundings outside that is free of other shapes, 0..255
    // The drawing's motion into the frame, if the source knows the motion:
    bool has_motion; // somewhere in the mask; else the two planes are undefined
    int32_t *motion; // interleaved, FL_MOTION_ONE a px, FL_MOTION_UNKNOWN; 2 * width * height
    int16_t *turn;   // the turn of the drawing, 65536 a turn; 0 where that is unknown
    float *share;    // of carry or strength, the engine's dial, from a control map; NULL: all of it
} FlGuides;

/** The pixel of the planes that lies at a place. */
static inline size_t fl_guides_at(const FlGuides *guides, int x, int y)
{
    return (size_t)y * (size_t)guides->width + (size_t)x;
}

static inline FlRect fl_guides_rect(const FlGuides *guides)
{
    return (FlRect){0, 0, guides->width, guides->height};
}

#define FL_MOTION_ONE 16384
#define FL_MOTION_UNKNOWN INT32_MIN // of both components: where motion is unknown, or no mask

/** A mask sequence, with its flow and the drawing's motion if they are known. */
typedef struct FlGuideSource {
    int width, height, n_frames;
    /** Writes frame's coverage, width * height bytes. May be called several times for a frame. */
    bool (*mask)(void *data, int frame, uint8_t *coverage, GError **error);
    /** Writes frame's flow, 2 * width * height floats; NULL: constructed from the masks. */
    bool (*flow)(void *data, int frame, float *flow, GError **error);
    void *data;
    /**
     * Writes the drawing's true displacement into the frame, 2 * width * height floats,
     * interleaved: the content of a pixel moved by it since the picture painted before; NAN:
     * unknown. It is used as given, neither smoothed nor part of the flow. Frames come in order,
     * with the outlines of `mask`. NULL: unknown in all frames.
     */
    bool (*motion)(void *data, int frame, const FlOutlinePair *outlines, float *motion,
                   GError **error);
    int first; // number of the first frame; every frame is known by its number
} FlGuideSource;

/** The guides of a whole sequence. Its memory does not grow with the number of frames (FlSpill). */
typedef struct FlGuideSequence FlGuideSequence;

/** Reads the whole sequence once. `source` is copied; its data must stay until _free. */
FlGuideSequence *fl_guide_sequence_new(const FlGuideSource *source, const FlGuideParams *params,
                                       GError **error);

void fl_guide_sequence_free(FlGuideSequence *sequence); // NULL is fine

/** Fills `guides`, which the caller made with fl_guides_init() in the size of the sequence. */
bool fl_guide_sequence_get(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                           GError **error);

/** The mask, the distance and the depth alone. */
bool fl_guide_sequence_distance(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                                GError **error);

/** All but the distance and the depth, which stay as they are. */
bool fl_guide_sequence_planes(const FlGuideSequence *sequence, int frame, FlGuides *guides,
                              GError **error);

/** True if a frame has the mask of the frame before and is free of motion, so that its guides need
 * not be read. */
bool fl_guide_sequence_rests(const FlGuideSequence *sequence, int frame);

bool fl_guides_init(FlGuides *guides, int width, int height, GError **error);
void fl_guides_clear(FlGuides *guides);

/** The smallest rectangle of pixels whose coverage is at least `least`. */
FlRect fl_guides_box(const FlGuides *guides, int least);

/** Frees the flow and the drawing's motion, from which no target is made. */
void fl_guides_drop_motion(FlGuides *guides);

/**
 * The shape guide of a mask: Gaussian blur of its coverage, sigma = border_px / 3, cut at border_px
 * [F21 §3.1]. In 0..1; pixels beyond the frame count as the nearest pixel of the frame.
 */
bool fl_shape_blur(const uint8_t *mask, int width, int height, float border_px, float *shape,
                   GError **error);

/** The thesis' shape guide min(distance / border_px, 1), not below 0 [P21 §3.4]. */
void fl_shape_ramp(const float *distance, int width, int height, float border_px, float *shape);

/**
 * A shape guide that near the contour depends on the depth alone, not on the contour's curvature:
 * 0.8 of a smoothstep from -edge_px to edge_px and 0.2 of the ramp. The blurred mask is lower in
 * tips and higher in notches, so equal depths differ.
 */
void fl_shape_edge(const float *distance, int width, int height, float border_px, float edge_px,
                   float *shape);

G_DEFINE_AUTOPTR_CLEANUP_FUNC(FlGuideSequence, fl_guide_sequence_free)
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlGuides, fl_guides_clear)
