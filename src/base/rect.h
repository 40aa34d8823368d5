/* A rectangle of pixels within a frame, and an area given by the columns of each row. */
#pragma once

#include <glib.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/** Returns: true if n bytes are 0; as fast as memcmp(). */
bool fl_is_blank(const uint8_t *bytes, size_t n);

/** Columns x … x + width - 1, rows y … y + height - 1; empty if a size is 0. */
typedef struct FlRect {
    int x, y, width, height;
} FlRect;

/** From column x0 and row y0 to before x1 and y1; {0, 0, 0, 0} if that is empty. */
static inline FlRect fl_rect_between(int x0, int y0, int x1, int y1)
{
    return x0 < x1 && y0 < y1 ? (FlRect){x0, y0, x1 - x0, y1 - y0} : (FlRect){0, 0, 0, 0};
}

/** The pixels that a part of the plane touches, whose numbers may be anything. */
static inline FlRect fl_rect_touched(double x0, double y0, double x1, double y1)
{
    enum { MOST = 1000000000 };
    return fl_rect_between(
        (int)floor(fmin(fmax(x0, -MOST), MOST)), (int)floor(fmin(fmax(y0, -MOST), MOST)),
        (int)ceil(fmin(fmax(x1, -MOST), MOST)), (int)ceil(fmin(fmax(y1, -MOST), MOST)));
}

FlRect fl_rect_and(FlRect a, FlRect b); // the intersection; {0, 0, 0, 0} if empty
FlRect fl_rect_or(FlRect a, FlRect b);  // the smallest that holds both; ignores empty ones
bool fl_rect_meet(FlRect a, FlRect b);  // true if they share a pixel

/** True if a rectangle, whose numbers may be anything, has a pixel and all are in `page`. */
bool fl_rect_is_inside(FlRect rect, FlRect page);

/** A rectangle with a margin of px on each side, as far as it lies within `limit`. */
FlRect fl_rect_grown(FlRect rect, int px, FlRect limit);

/** Moves the left and the upper edge outwards to multiples of `grid`; x, y >= 0. */
FlRect fl_rect_on_grid(FlRect rect, int grid);

/** The smallest rectangle with every nonzero byte of a width * height plane; {0, 0, 0, 0} if all
 * are 0. */
FlRect fl_rect_of(const uint8_t *plane, int width, int height);

/** The same within a part of a plane that is `width` wide. */
FlRect fl_rect_within(const uint8_t *plane, int width, FlRect part);

/** Clears a part of a plane that is `width` wide. */
void fl_rect_clear(uint8_t *plane, int width, FlRect part);

/** Copies the pixels that two rectangles of a frame share; from and to have one rectangle each. */
void fl_rect_copy(const void *from, FlRect from_rect, void *to, FlRect to_rect, size_t pixel_bytes);

/** Columns first … last - 1; empty if first >= last. */
typedef struct FlColumns {
    int first, last;
} FlColumns;

/** The area of a shape in a frame; many shapes are far smaller than their bounding rectangle. */
typedef struct FlArea {
    FlRect box;
    FlColumns *row; // of each row of the box, within 0 … box.width; NULL: rows are full
} FlArea;

/** The area of a width * height plane: in each row from the first nonzero byte to the last. */
void fl_area_init(FlArea *area, const uint8_t *plane, int width, int height);
void fl_area_clear(FlArea *area);

/** The columns of row y of the box. */
static inline FlColumns fl_area_row(const FlArea *area, int y)
{
    return area->row ? area->row[y] : (FlColumns){0, area->box.width};
}

G_DEFINE_AUTO_CLEANUP_CLEAR_FUNC(FlArea, fl_area_clear)

/** Returns: true if eight bytes are 0. */
static inline bool fl_eight_blank(const uint8_t *bytes)
{
    uint64_t eight;
    memcpy(&eight, bytes, sizeof eight);
    return eight == 0;
}

/** The next columns from x on in which a row is anything but 0, but for a few: nearly all that is
 * left out of a row are long stretches. Where they are empty, the row has ended. */
static inline FlColumns fl_next_run(const uint8_t *row, int x, int end)
{
    while (x + 8 <= end && fl_eight_blank(row + x))
        x += 8;
    int last = x;
    while (last < end && (last + 8 > end || !fl_eight_blank(row + last)))
        last = MIN(last + 8, end);
    return (FlColumns){x, last};
}

static inline size_t fl_rect_pixels(FlRect rect)
{
    return (size_t)rect.width * (size_t)rect.height;
}

/** A side of half the size; halves count as whole pixels. */
static inline int fl_half_side(int px)
{
    return (px + 1) / 2;
}

/** A rectangle in a frame of half the size; its corner is even. */
static inline FlRect fl_rect_halved(FlRect rect)
{
    return (FlRect){rect.x / 2, rect.y / 2, fl_half_side(rect.width), fl_half_side(rect.height)};
}

/** A rectangle of fl_half_side() of a frame in the frame, which is as large as `page`. */
static inline FlRect fl_rect_doubled(FlRect rect, FlRect page)
{
    return fl_rect_and((FlRect){2 * rect.x, 2 * rect.y, 2 * rect.width, 2 * rect.height}, page);
}
