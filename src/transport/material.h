/* Maps each pixel of a region to its material, so that the pattern moves with the drawing. */
#pragma once

#include "base/rect.h"
#include "guides/guides.h"

/**
 * Coordinates of the material under the pixels of a rectangle: a pixel at (x, y) shows the material
 * at (x, y) + shift. In a first frame all shifts are 0.
 */
typedef struct FlMaterial {
    FlRect rect;  // of the frames; empty: there was no region
    float *shift; // interleaved, 2 * rect.width * rect.height px; owned
} FlMaterial;

/** The motion that brought the content of a pixel into the frame, px; motion may be NULL. Returns:
 * true if it is known; else the motion is 0. */
bool fl_material_motion(const FlGuides *guides, int x, int y, float motion[2]);

/**
 * The material of the next frame in `rect`: carried by the drawing's motion where that is known,
 * else by the flow of its outlines, and continued from its surroundings where something appears.
 * `guides` are of whole frames. FL_ERROR_NO_MEMORY.
 */
bool fl_material_advance(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                         FlMaterial *now, GError **error);

/** The same of pairs of numbers in place of shifts, which stay as they are. */
bool fl_material_carry(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                       FlMaterial *now, GError **error);

/**
 * The matrix from displacements of the material to those of the frame at a pixel: the gradient's
 * inverse, so that the density of ink does not depend on the material's deformation. It stretches
 * by a factor of 2 at most.
 */
void fl_material_inverse(const FlMaterial *material, int x, int y, float inverse[2][2]);

/** Returns: true if a pixel of the rectangle is in the region. */
bool fl_material_is_inside(const FlMaterial *material, const FlGuides *guides, int x, int y);

/**
 * The strain of the material around each pixel of its rectangle: the share, 0..1, of the region
 * within `reach_px` whose pattern is stretched or squeezed too far; by smooth steps, 0 up to a
 * factor of 1.35 and 1 from 1.9. FL_ERROR_NO_MEMORY.
 */
bool fl_material_strain(const FlMaterial *material, const FlGuides *guides, int reach_px,
                        float *strain, GError **error);

/**
 * The share of each pixel that is whole, 0..1: 0 where two shapes of the region meet with materials
 * that do not fit, or with different shares of the layers, rising to 1 at a distance of `reach_px`.
 * A shape whose material is squeezed alike all over is whole. share has shifts or not.
 * FL_ERROR_NO_MEMORY.
 */
bool fl_material_whole(const FlMaterial *material, const FlMaterial *share, const FlGuides *guides,
                       float reach_px, float *whole, GError **error);

/** The material as it would lie had it only been turned and moved: the best fit in the region. */
bool fl_material_relaxed(const FlMaterial *material, const FlGuides *guides, FlMaterial *relaxed,
                         GError **error);

void fl_material_clear(FlMaterial *material);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlMaterial, fl_material_clear)
