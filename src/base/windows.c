#include "base/windows.h"

#define BAND 128 // columns that are summed side by side, as they lie in memory

/** Sums of a row over 2 r + 1 columns. */
static void sum_columns(const int16_t *plane, uint32_t *out, int n, int r)
{
    uint32_t sum = 0;
    for (int i = -r; i < n; i++) {
        if (i + r < n)
            sum += (uint32_t)plane[i + r];
        if (i >= 0)
            out[i] = sum;
        if (i - r >= 0)
            sum -= (uint32_t)plane[i - r];
    }
}

/** Sums of the sums over 2 r + 1 rows, of n <= BAND columns of a box. */
static void sum_rows(const uint32_t *in, uint32_t *out, int n, FlRect box, int r)
{
    const size_t width = (size_t)box.width;
    uint32_t sum[BAND] = {0};
    for (int y = -r; y < box.height; y++) {
        const uint32_t *enter = y + r < box.height ? in + (size_t)(y + r) * width : NULL;
        const uint32_t *leave = y - r >= 0 ? in + (size_t)(y - r) * width : NULL;
        for (int x = 0; x < n && enter; x++)
            sum[x] += enter[x];
        for (int x = 0; x < n && y >= 0; x++)
            out[(size_t)y * width + (size_t)x] = sum[x];
        for (int x = 0; x < n && leave; x++)
            sum[x] -= leave[x];
    }
}

void fl_window_sums(const int16_t *plane, FlRect box, int r, uint32_t *rows, uint32_t *sums)
{
    const size_t width = (size_t)box.width;
    for (int y = 0; y < box.height; y++)
        sum_columns(plane + (size_t)y * width, rows + (size_t)y * width, box.width, r);
    for (int x = 0; x < box.width; x += BAND)
        sum_rows(rows + x, sums + x, MIN(BAND, box.width - x), box, r);
}
