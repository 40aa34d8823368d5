#include "base/box.h"

#include <glib.h>
#include <stdbool.h>

/* Most rows of most planes are blank, which is seen without looking for where they begin. */
static bool is_blank(const uint8_t *row, int width)
{
    uint8_t any = 0;
    for (int x = 0; x < width; x++)
        any |= row[x];
    return any == 0;
}

FlBox fl_box_of(const uint8_t *plane, int width, int height)
{
    int left = width, right = -1, top = height, bottom = -1;
    for (int y = 0; y < height; y++) {
        const uint8_t *row = plane + (size_t)y * width;
        int first = 0, last = width - 1;
        if (is_blank(row, width))
            continue;
        while (!row[first])
            first++;
        while (!row[last])
            last--;
        left = MIN(left, first), right = MAX(right, last);
        top = MIN(top, y), bottom = y;
    }
    return right < 0 ? (FlBox){0, 0, 0, 0} : (FlBox){left, top, right - left + 1, bottom - top + 1};
}
