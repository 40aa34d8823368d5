/* Sums over square windows, and how wide what is in them is. */
#ifndef FLUIDY_COMPOSE_WINDOWS_H
#define FLUIDY_COMPOSE_WINDOWS_H

#include "base/rect.h"

/** Sums of a plane, 0 or more, over 2 r + 1 columns and rows, of every pixel of a box; what is
 * beyond is 0. rows: scratch. All have box.width * box.height elements. */
void fl_window_sums(const int16_t *plane, FlRect box, int r, uint32_t *rows, uint32_t *sums);

/** Sixteenths of a pixel: up to `all` something is narrow, and from `none` on it is not. */
typedef struct FlWidths {
    int all, none;
} FlWidths;

/** The radius, px, of windows hardly wider than `none`, which is then 1.1 to 1.2 times `all`: in
 * squares of so much more than the width of a line there is as much of it at any angle. */
static inline int fl_window_radius(FlWidths widths)
{
    return (widths.none + 16) / 32;
}

/** How wide, 0 … 255, is what has this sum in such a window, where it is 255 a pixel. */
static inline uint8_t fl_window_width(FlWidths widths, uint32_t sum)
{
    const int side = 2 * fl_window_radius(widths) + 1;
    const int least = 255 * side * widths.all, unit = side * (widths.none - widths.all);
    return (uint8_t)(CLAMP(16 * (int)sum - least, 0, 255 * unit) / unit);
}

#endif
