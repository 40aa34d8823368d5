#include "base/windows.h"

#define BAND 128 // columns that are summed side by side, as they lie in memory

/** The value of a column; 0 beyond the row. */
static uint32_t value_at(const int16_t *plane, int n, int i)
{
    return i >= 0 && i < n ? (uint32_t)plane[i] : 0;
}

/** Sums of a row over 2 r + 1 columns; both ends of most windows are within the row. */
static void sum_columns(const int16_t *plane, uint32_t *restrict out, int n, int r)
{
    const int whole = MIN(r + 1, n), end = MAX(n - r, whole);
    uint32_t sum = 0;
    for (int i = 0; i < MIN(r, n); i++)
        sum += (uint32_t)plane[i];
    for (int i = 0; i < whole; i++)
        out[i] = sum += value_at(plane, n, i + r);
    for (int i = whole; i < end; i++)
        out[i] = sum += (uint32_t)(plane[i + r] - plane[i - r - 1]);
    for (int i = end; i < n; i++)
        out[i] = sum -= value_at(plane, n, i - r - 1);
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
