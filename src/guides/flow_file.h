/* Flow fields in files, which may be better than those made from masks. */
#pragma once

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * Reads a flow field of width * height pixels: interleaved u (right), v (down), px per frame.
 *
 * A name that ends in .flo is Middlebury's format: the float 202021.25 ("PIEH"), width and height
 * as 32-bit integers, then the pairs; components above 1e9 there mean that it is unknown. Any
 * other name is raw: the pairs alone. All is little-endian, 32-bit floats, row-major.
 *
 * unknown: the value of both components where one is unknown, such as 0 or NAN.
 * Returns: false with FL_ERROR_INPUT set, if the file is missing, has another size or holds a
 * component that is not a number or beyond 1e5 px; FL_ERROR_NO_MEMORY.
 */
bool fl_flow_load(const char *path, int width, int height, float unknown, float *flow,
                  GError **error);

/** The flow at half the size, as fl_half_side() says; lengths become those of the small frame. */
void fl_flow_halve(const float *flow, int width, int height, float *half);

/** Writes one atomically, in the format of its name; NAN is unknown,
 * which raw files cannot say. FL_ERROR_OUTPUT. */
bool fl_flow_save(const char *path, int width, int height, const float *flow, GError **error);
