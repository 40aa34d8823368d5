/* Planes of half the size, by which drafts are painted, in the size of the picture. */
#pragma once

#include <stddef.h>

/** A flow in twice its size, width * height, in px of the larger size. */
void fl_flow_double(const float *half, int width, int height, float *full);

/** A plane of `bytes` a pixel in a larger size, width * height: each pixel px * px times. */
void fl_plane_repeat(const void *plane, int width, int height, size_t bytes, int px, void *full);
