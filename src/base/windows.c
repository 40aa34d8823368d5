#include "base/windows.h"

/** Takes n columns of a row into their sums, and those of another one out of them. */
static void move_rows(const int16_t *enters, const int16_t *leaves, size_t n,
                      uint32_t *restrict sums)
{
    for (size_t x = 0; x < n; x++)
        sums[x] += (uint32_t)(enters[x] - leaves[x]);
}

/** Sums of 2 r + 1 columns around each of n; there are r more on both sides, and one before. */
static void add_columns(const uint32_t *columns, size_t n, size_t r, uint32_t *restrict out)
{
    uint32_t sum = 0;
    for (size_t x = 0; x < 2 * r; x++)
        sum += columns[1 + x];
    for (size_t x = 0; x < n; x++)
        out[x] = sum += columns[1 + x + 2 * r] - columns[x];
}

void fl_window_sums(const int16_t *plane, FlRect box, int r, uint32_t *sums)
{
    const size_t width = (size_t)box.width, reach = (size_t)r;
    g_autofree uint32_t *columns = g_new0(uint32_t, width + 2 * reach + 1);
    g_autofree int16_t *beyond = g_new0(int16_t, MAX(width, 1));
    for (int y = -r; y < box.height; y++) {
        const int16_t *enters = y + r < box.height ? plane + (size_t)(y + r) * width : beyond;
        const int16_t *leaves = y > r ? plane + (size_t)(y - r - 1) * width : beyond;
        move_rows(enters, leaves, width, columns + reach + 1);
        if (y >= 0)
            add_columns(columns, width, reach, sums + (size_t)y * width);
    }
}
