/* Regions at rest: what has not moved is painted as it was. */
#pragma once

#include "guides/guides.h"

#define FL_REST_DEEP 2.5f // borders up to which the depth counts
#define FL_REST_STEPS 127 // of that depth

/** The definition of rest. */
typedef struct FlRestRule {
    float border_px;
    float still;   // the fastest flow, px a frame
    float unit_px; // that of FlDrying; 0: paint does not dry
    bool plays;    // it shows the exemplar by its age
} FlRestRule;

/**
 * Writes the plane by which a region at rest is recognised, as large as the guides: the mask, and
 * inside the mask the depth, which also depends on shapes that move beside the region.
 */
void fl_rest_shape(const FlGuides *guides, const FlRestRule *rule, uint8_t *shape);

/** The depth of a pixel inside; FL_REST_STEPS are FL_REST_DEEP borders. Undefined at the very
 * edge. */
static inline int fl_rest_depth(uint8_t shape)
{
    return shape ^ 255;
}

/**
 * last_wet may be NULL where paint does not dry.
 *
 * Returns: true if a region rests: its shape is that of the last frame, which fl_rest_shape()
 * filled in, its paint was as wet as at rest, and no flow inside is faster than rule->still. A
 * motion of the drawing that is known is no rest, however slow it is, since it is seen after some
 * frames.
 */
bool fl_rests(const FlGuides *guides, const FlRestRule *rule, const uint8_t *last_shape,
              const uint8_t *last_wet);
