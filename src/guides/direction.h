/* The direction guide: an 8-bit angle, also defined for pixels at rest. */
#pragma once

#include <stddef.h>
#include <stdint.h>

/** Angle of a vector, 256 steps a turn, 0 along +x, 64 along +y; 0 for (0, 0). Same on every CPU.
 */
uint8_t fl_angle(float x, float y);

/** The same in 1/256 of these steps: 65536 a turn, from half a turn back to just below half a turn.
 */
int16_t fl_fine_angle(float x, float y);

/**
 * Directions of n pixels: below still_px that of the normal, from twice still_px on that of the
 * flow, between them a smooth blend of both. flow may be NULL: no motion. Arrays are interleaved
 * pairs; normals need no unit length. 0 where coverage is below FL_INSIDE.
 */
void fl_direction(const uint8_t *coverage, const float *flow, const float *normal, size_t n,
                  float still_px, uint8_t *angle);
