/* A rectangle of pixels within a frame. */
#ifndef FLUIDY_BASE_BOX_H
#define FLUIDY_BASE_BOX_H

#include <stddef.h>
#include <stdint.h>

/** Columns x … x + width - 1, rows y … y + height - 1; empty if a size is 0. */
typedef struct FlBox {
    int x, y, width, height;
} FlBox;

/** The smallest box that holds every nonzero byte of a width * height plane; {0, 0, 0, 0}: none. */
FlBox fl_box_of(const uint8_t *plane, int width, int height);

static inline size_t fl_box_pixels(FlBox box)
{
    return (size_t)box.width * (size_t)box.height;
}

/** A side of half the size; halves count as whole pixels. */
static inline int fl_half_side(int px)
{
    return (px + 1) / 2;
}

#endif
