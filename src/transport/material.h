/* Where each pixel of a region lies on its material: the pattern rides on the drawing. */
#ifndef FLUIDY_TRANSPORT_MATERIAL_H
#define FLUIDY_TRANSPORT_MATERIAL_H

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

/**
 * The material of the next frame in `rect`: carried by the drawing's motion where that is known,
 * by the flow of its outlines where none is, and continued from its surroundings where something
 * appears. `guides` are of whole frames. FL_ERROR_NO_MEMORY.
 */
bool fl_material_advance(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                         FlMaterial *now, GError **error);

/** The same of pairs of numbers in place of shifts, which stay as they are. */
bool fl_material_carry(const FlMaterial *before, const FlGuides *guides, FlRect rect,
                       FlMaterial *now, GError **error);

/**
 * How the material lies at a pixel of the rectangle: the columns of d(material) / d(pixel), by
 * central differences.
 */
void fl_material_gradient(const FlMaterial *material, int x, int y, float f[2][2]);

/** Whether a pixel of the rectangle is in the region. */
bool fl_material_is_inside(const FlMaterial *material, const FlGuides *guides, int x, int y);

/**
 * How strained the material is around each pixel of its rectangle: the share, 0..1, of the region
 * within `reach_px` whose pattern is stretched or squeezed too far; by smooth steps, 0 up to a
 * factor of 1.35 and 1 from 1.9. FL_ERROR_NO_MEMORY.
 */
bool fl_material_strain(const FlMaterial *material, const FlGuides *guides, int reach_px,
                        float *strain, GError **error);

/** The material as it would lie had it only been turned and moved: the best fit in the region. */
bool fl_material_relaxed(const FlMaterial *material, const FlGuides *guides, FlMaterial *relaxed,
                         GError **error);

void fl_material_clear(FlMaterial *material);
G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlMaterial, fl_material_clear)

#endif
