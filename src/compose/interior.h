/* The inner pixels of a mask: where paint is not that of an edge. */
#ifndef FLUIDY_COMPOSE_INTERIOR_H
#define FLUIDY_COMPOSE_INTERIOR_H

#include <stdint.h>

/**
 * Row y of what lies inside a width * height mask, 0..255, with a margin: inner[x], of width bytes,
 * becomes the least of the mask at the pixel and at the corners and sides of a square margin_px
 * around. Beyond the mask it is taken to go on.
 */
void fl_interior_row(const uint8_t *mask, int width, int height, int y, int margin_px,
                     uint8_t *inner);

#endif
