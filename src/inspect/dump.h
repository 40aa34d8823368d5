/* The guides, the field and T_temp of a frame, as pictures and raw data: --dump. */
#pragma once

#include "compose/painted_region.h"

/**
 * Writes a painter's guides, field and T_temp of the frame it has just painted into
 * folder/REGION/: a PNG to look at and little-endian 32-bit floats to compute with, row-major and
 * as large as the frame, 0 outside painted->rect. Names are
 * WHAT_NUMBER.png and .f32:
 *
 *   mask         0 … 1                              1 float per pixel
 *   distance     px, positive inside                1
 *   flow         px into the frame, u then v        2; as .flo too
 *   motion       the drawing's own, where known     2; only as .flo
 *   ext-plus     px                                 1
 *   ext-minus    px                                 1
 *   field        frame, x, y (px), theta (radians)  4; all -1 where there is none
 *   temporal     T_temp, r, g, b in 0 … 1           3
 *   temporal-weight  m(q), 0 … 1                    1
 *
 * Returns: false with FL_ERROR_OUTPUT set.
 */
bool fl_dump_frame(const char *folder, const FlPaintedRegion *painted, const FlGuides *guides,
                   int number, GError **error);
