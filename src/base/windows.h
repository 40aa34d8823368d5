/* Sums over square windows. */
#pragma once

#include "base/rect.h"

/** Sums of a plane, 0 or more, over 2 r + 1 columns and rows, of every pixel of a box; what is
 * beyond is 0. Both have box.width * box.height elements. */
void fl_window_sums(const int16_t *plane, FlRect box, int r, uint32_t *sums);
