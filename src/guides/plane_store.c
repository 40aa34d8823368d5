#include "guides/plane_store.h"

#include "base/alloc.h"

/** Difference from the value one step before, folded so that it is small when it is near 0. */
static uint32_t fold(const int32_t *values, size_t k, size_t step)
{
    const uint32_t d = (uint32_t)values[k] - (k >= step ? (uint32_t)values[k - step] : 0);
    return (d << 1) ^ (d >> 31 ? UINT32_MAX : 0);
}

bool fl_plane_store_put(FlSpill *spill, size_t block, const int32_t *values, size_t n, size_t step,
                        GError **error)
{
    uint32_t used = 1; // at least one byte each
    for (size_t k = 0; k < n; k++)
        used |= fold(values, k, step);
    const int n_planes = (39 - __builtin_clz(used)) / 8;
    g_autofree uint8_t *bytes = fl_alloc_unset(n, (size_t)n_planes, "a temporary plane", error);
    if (!bytes)
        return false;
    for (int b = 0; b < n_planes; b++)
        for (size_t k = 0; k < n; k++)
            bytes[b * n + k] = (uint8_t)(fold(values, k, step) >> (8 * b));
    return fl_spill_put(spill, block, bytes, n * n_planes, error);
}

/** Puts the bytes of planes together, plane by plane. */
static void join(const uint8_t *bytes, size_t n, int n_planes, uint32_t *restrict values)
{
    for (size_t k = 0; k < n; k++)
        values[k] = bytes[k];
    for (int b = 1; b < n_planes; b++)
        for (size_t k = 0; k < n; k++)
            values[k] |= (uint32_t)bytes[(size_t)b * n + k] << (8 * b);
}

static uint32_t unfolded(uint32_t folded)
{
    return (folded >> 1) ^ (folded & 1 ? UINT32_MAX : 0);
}

bool fl_plane_store_get(const FlSpill *spill, size_t block, int32_t *values, size_t n, size_t step,
                        GError **error)
{
    const int n_planes = (int)(fl_spill_bytes(spill, block) / n);
    g_autofree uint8_t *bytes = fl_alloc_unset(n, (size_t)n_planes, "a temporary plane", error);
    uint32_t *sums = (uint32_t *)values;
    if (!bytes || !fl_spill_get(spill, block, bytes, n * n_planes, error))
        return false;
    join(bytes, n, n_planes, sums);
    for (size_t k = 0; k < n; k++)
        sums[k] = unfolded(sums[k]);
    for (size_t k = step; k < n; k++)
        sums[k] += sums[k - step];
    return true;
}
