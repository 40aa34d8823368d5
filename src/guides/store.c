#include "guides/store.h"

static bool no_memory(GError **error)
{
    g_set_error(error, FL_ERROR, FL_ERROR_NO_MEMORY, "not enough memory for a temporary plane");
    return false;
}

bool fl_store_put(FlSpill *spill, size_t block, const int32_t *values, size_t n, size_t step,
                  GError **error)
{
    g_autofree uint8_t *bytes = g_try_malloc(n * sizeof *values);
    if (!bytes)
        return no_memory(error);
    for (size_t k = 0; k < n; k++) {
        const uint32_t d = (uint32_t)values[k] - (k >= step ? (uint32_t)values[k - step] : 0);
        const uint32_t folded = (d << 1) ^ (d >> 31 ? UINT32_MAX : 0); // small when |d| is small
        for (int b = 0; b < 4; b++)
            bytes[b * n + k] = (uint8_t)(folded >> (8 * b));
    }
    return fl_spill_put(spill, block, bytes, n * sizeof *values, error);
}

bool fl_store_get(const FlSpill *spill, size_t block, int32_t *values, size_t n, size_t step,
                  GError **error)
{
    g_autofree uint8_t *bytes = g_try_malloc(n * sizeof *values);
    if (!bytes)
        return no_memory(error);
    if (!fl_spill_get(spill, block, bytes, n * sizeof *values, error))
        return false;
    for (size_t k = 0; k < n; k++) {
        uint32_t folded = 0;
        for (int b = 0; b < 4; b++)
            folded |= (uint32_t)bytes[b * n + k] << (8 * b);
        const uint32_t d = (folded >> 1) ^ (folded & 1 ? UINT32_MAX : 0);
        values[k] = (int32_t)(d + (k >= step ? (uint32_t)values[k - step] : 0));
    }
    return true;
}
