/** @file
 * Limits on what an input file may ask for. Threads: one thread sets them, before any other calls
 * the library.
 */
#ifndef FLUIDY_LIMITS_H
#define FLUIDY_LIMITS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

G_BEGIN_DECLS

/**
 * Changes a limit for the whole process, such as "elements=500000"; see fluidy-svg(1) for their
 * names. Call it before anything else, from one thread.
 *
 * Returns: false with FL_ERROR_USAGE set: no such limit, or not an integer in its range.
 */
FL_API bool fl_limit_set(const char *text, GError **error);

G_END_DECLS

#endif
