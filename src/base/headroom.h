/* Memory head-room for libraries, which abort where an allocation fails. */
#ifndef FLUIDY_BASE_HEADROOM_H
#define FLUIDY_BASE_HEADROOM_H

#include <fluidy/error.h>
#include <stdbool.h>

/**
 * Checks that there is memory for the small allocations of GLib, librsvg and OpenMP, and for the
 * stacks of all threads. Frames and fields, which are far larger, do not count: fl_alloc() reports
 * their failure. Call it when the number of threads is known, before files are read.
 *
 * Returns: false with FL_ERROR_NO_MEMORY set.
 */
bool fl_headroom_check(GError **error);

/**
 * Returns: true unless the address space was limited at the first call and too little is left for
 * small allocations. In that case fl_alloc() fails, since only fl_alloc() can report the lack of
 * memory.
 */
bool fl_headroom_left(void);

#endif
