/* Planes of integers in a spill: smooth ones shrink a lot, for neighbours differ by little. */
#pragma once

#include "base/spill.h"
#include <stdint.h>

/** Stores n integers as differences from the one `step` before, sorted by significance of the
 * bytes. */
bool fl_plane_store_put(FlSpill *spill, size_t block, const int32_t *values, size_t n, size_t step,
                        GError **error);

/** Reads n integers that were stored with the same step. */
bool fl_plane_store_get(const FlSpill *spill, size_t block, int32_t *values, size_t n, size_t step,
                        GError **error);
