/* Limits on what an input file may ask for: the checks. The table is limits.def. */
#pragma once

#include <fluidy/limits.h>

typedef enum FlLimit {
#define FL_LIMIT(constant, name, default_value, most, what) FL_LIMIT_##constant,
#include "base/limits.def"
#undef FL_LIMIT
    FL_N_LIMITS
} FlLimit;

/** The current limit, in the unit of limits.def. */
int64_t fl_limit(FlLimit limit);

/** Sets all limits, to what fl_limit() gave in another process. */
void fl_limits_set_all(const int64_t limit[FL_N_LIMITS]);

/**
 * Checks that `wanted`, in the unit of limits.def, is within the limit. `where`, usually a file's
 * name, starts the message.
 *
 * Returns: false with FL_ERROR_LIMIT set, which says how to raise the limit.
 */
bool fl_limit_check(FlLimit limit, double wanted, const char *where, GError **error);
