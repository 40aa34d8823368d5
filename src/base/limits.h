/* How much a file may ask for, as the stages ask: see limits.def. */
#ifndef FLUIDY_BASE_LIMITS_H
#define FLUIDY_BASE_LIMITS_H

#include <fluidy/limits.h>

typedef enum FlLimit {
#define FL_LIMIT(constant, name, preset, most, what) FL_LIMIT_##constant,
#include "base/limits.def"
#undef FL_LIMIT
    FL_N_LIMITS
} FlLimit;

/** The limit that holds, in the unit of limits.def. */
int64_t fl_limit(FlLimit limit);

/**
 * Whether `wanted`, in the unit of limits.def, is within the limit. `where` names the file or what
 * else asks for it, and starts the message.
 *
 * Returns: false with FL_ERROR_LIMIT set, which says how to raise the limit.
 */
bool fl_limit_check(FlLimit limit, double wanted, const char *where, GError **error);

#endif
