#include "base/rect.h"

#include <string.h>

bool fl_is_blank(const uint8_t *bytes, size_t n)
{
    return n == 0 || (bytes[0] == 0 && memcmp(bytes, bytes + 1, n - 1) == 0);
}

/* From the first nonzero byte of a row to the last; the row is not blank. */
static FlColumns span_of(const uint8_t *row, int width)
{
    FlColumns span = {0, width};
    while (span.first + 8 <= width && fl_eight_blank(row + span.first))
        span.first += 8;
    while (!row[span.first])
        span.first++;
    while (span.last >= 8 && fl_eight_blank(row + span.last - 8))
        span.last -= 8;
    while (!row[span.last - 1])
        span.last--;
    return span;
}

FlRect fl_rect_within(const uint8_t *plane, int width, FlRect part)
{
    int left = part.width, right = -1, top = part.height, bottom = -1;
    const int block = part.width == width ? 16 : 1; // rows that are looked at together
    for (int y = 0; y < part.height; y++) {
        const uint8_t *row = plane + (size_t)(part.y + y) * width + part.x;
        const int rows = y % block == 0 ? MIN(block, part.height - y) : 1;
        if (fl_is_blank(row, (size_t)rows * part.width)) { // as most of most planes
            y += rows - 1;
            continue;
        }
        if (fl_is_blank(row, (size_t)part.width))
            continue;
        const FlColumns span = span_of(row, part.width);
        left = MIN(left, span.first), right = MAX(right, span.last - 1);
        top = MIN(top, y), bottom = y;
    }
    return right < 0 ? (FlRect){0, 0, 0, 0}
                     : (FlRect){part.x + left, part.y + top, right - left + 1, bottom - top + 1};
}

FlRect fl_rect_of(const uint8_t *plane, int width, int height)
{
    return fl_rect_within(plane, width, (FlRect){0, 0, width, height});
}

FlRect fl_rect_and(FlRect a, FlRect b)
{
    return fl_rect_between(MAX(a.x, b.x), MAX(a.y, b.y), MIN(a.x + a.width, b.x + b.width),
                           MIN(a.y + a.height, b.y + b.height));
}

FlRect fl_rect_or(FlRect a, FlRect b)
{
    if (fl_rect_pixels(a) == 0 || fl_rect_pixels(b) == 0)
        return fl_rect_pixels(a) == 0 ? b : a;
    return fl_rect_between(MIN(a.x, b.x), MIN(a.y, b.y), MAX(a.x + a.width, b.x + b.width),
                           MAX(a.y + a.height, b.y + b.height));
}

bool fl_rect_meet(FlRect a, FlRect b)
{
    return fl_rect_pixels(fl_rect_and(a, b)) > 0;
}

FlRect fl_rect_grown(FlRect rect, int px, FlRect limit)
{
    const FlRect grown = {rect.x - px, rect.y - px, rect.width + 2 * px, rect.height + 2 * px};
    return fl_rect_and(grown, limit);
}

bool fl_rect_is_inside(FlRect rect, FlRect page)
{
    return rect.width > 0 && rect.height > 0 && rect.x >= page.x && rect.y >= page.y &&
           rect.width <= page.width && rect.height <= page.height &&
           rect.x - page.x <= page.width - rect.width &&
           rect.y - page.y <= page.height - rect.height;
}

FlRect fl_rect_on_grid(FlRect rect, int grid)
{
    const int left = rect.x % grid, above = rect.y % grid;
    return (FlRect){rect.x - left, rect.y - above, rect.width + left, rect.height + above};
}

void fl_rect_clear(uint8_t *plane, int width, FlRect part)
{
    for (int y = part.y; y < part.y + part.height; y++)
        memset(plane + (size_t)y * (size_t)width + part.x, 0, (size_t)part.width);
}

void fl_rect_copy(const void *from, FlRect from_rect, void *to, FlRect to_rect, size_t pixel_bytes)
{
    const FlRect both = fl_rect_and(from_rect, to_rect);
    const size_t from_row = pixel_bytes * (size_t)from_rect.width;
    const size_t to_row = pixel_bytes * (size_t)to_rect.width;
    for (int y = both.y; y < both.y + both.height; y++)
        memcpy((char *)to + (size_t)(y - to_rect.y) * to_row +
                   pixel_bytes * (size_t)(both.x - to_rect.x),
               (const char *)from + (size_t)(y - from_rect.y) * from_row +
                   pixel_bytes * (size_t)(both.x - from_rect.x),
               pixel_bytes * (size_t)both.width);
}

void fl_area_init(FlArea *area, const uint8_t *plane, int width, int height)
{
    const FlRect box = fl_rect_of(plane, width, height);
    *area = (FlArea){box, g_new0(FlColumns, MAX(box.height, 1))};
    for (int y = 0; y < box.height; y++) {
        const uint8_t *row = plane + (size_t)(box.y + y) * width + box.x;
        if (!fl_is_blank(row, (size_t)box.width))
            area->row[y] = span_of(row, box.width);
    }
}

void fl_area_clear(FlArea *area)
{
    g_free(area->row);
    *area = (FlArea){0};
}
