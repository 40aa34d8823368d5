#include "compose/interior.h"

#include <glib.h>
#include <string.h>

static void keep_least(uint8_t *restrict row, const uint8_t *other, int n)
{
    for (int x = 0; x < n; x++)
        row[x] = MIN(row[x], other[x]);
}

void fl_interior_row(const uint8_t *mask, int width, int height, int y, int margin_px,
                     uint8_t *inner)
{
    const int above = y - margin_px, below = y + margin_px, n = MAX(width - margin_px, 0);
    g_autofree uint8_t *rows = g_memdup2(mask + (size_t)y * width, (size_t)width);
    if (above >= 0)
        keep_least(rows, mask + (size_t)above * width, width);
    if (below < height)
        keep_least(rows, mask + (size_t)below * width, width);
    memcpy(inner, rows, (size_t)width);
    keep_least(inner + margin_px, rows, n);
    keep_least(inner, rows + margin_px, n);
}
