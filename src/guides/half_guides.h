/* Guides of half the size, by which drafts are painted. */
#pragma once

#include "guides/guides.h"

/** A flow in twice its size, width * height, in px of the larger size. */
void fl_flow_double(const float *half, int width, int height, float *full);

/** A plane of `bytes` a pixel in twice its size, width * height: each pixel four times. */
void fl_plane_double(const void *half, int width, int height, size_t bytes, void *full);

/**
 * The guides in twice their size, with lengths of the large frame, for inspection.
 *
 * full: empty, to be cleared. FL_ERROR_NO_MEMORY.
 */
bool fl_guides_double(const FlGuides *half, int width, int height, FlGuides *full, GError **error);
