/* How much a file may ask for. */
#ifndef FLUIDY_LIMITS_H
#define FLUIDY_LIMITS_H

#include <fluidy/error.h>
#include <stdbool.h>
#include <stdint.h>

G_BEGIN_DECLS

/**
 * Changes a limit for the whole process, such as "elements=500000"; see fluidy-svg(1) for their
 * names. To be called before anything else: it is not for several threads.
 *
 * Returns: false with FL_ERROR_USAGE set: no such limit, or no whole number in its range.
 */
FL_API bool fl_limit_set(const char *text, GError **error);

/** "name (default): what is counted", a line per limit; to be freed with g_free(). */
FL_API char *fl_limit_help(void);

G_END_DECLS

#endif
