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

bool fl_plane_store_get(const FlSpill *spill, size_t block, int32_t *values, size_t n, size_t step,
                        GError **error)
{
    const int n_planes = (int)(fl_spill_bytes(spill, block) / n);
    g_autofree uint8_t *bytes = fl_alloc_unset(n, (size_t)n_planes, "a temporary plane", error);
    if (!bytes || !fl_spill_get(spill, block, bytes, n * n_planes, error))
        return false;
    for (size_t k = 0; k < n; k++) {
        uint32_t folded = 0;
        for (int b = 0; b < n_planes; b++)
            folded |= (uint32_t)bytes[b * n + k] << (8 * b);
        const uint32_t d = (folded >> 1) ^ (folded & 1 ? UINT32_MAX : 0);
        values[k] = (int32_t)(d + (k >= step ? (uint32_t)values[k - step] : 0));
    }
    return true;
}
