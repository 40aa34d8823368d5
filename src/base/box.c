#include "base/box.h"

#include <glib.h>

FlBox fl_box_of(const uint8_t *plane, int width, int height)
{
    int left = width, right = -1, top = height, bottom = -1;
    for (int y = 0; y < height; y++) {
        const uint8_t *row = plane + (size_t)y * width;
        int first = 0, last = width - 1;
        while (first < width && !row[first])
            first++;
        if (first == width)
            continue;
        while (!row[last])
            last--;
        left = MIN(left, first), right = MAX(right, last);
        top = MIN(top, y), bottom = y;
    }
    return right < 0 ? (FlBox){0, 0, 0, 0} : (FlBox){left, top, right - left + 1, bottom - top + 1};
}
