/* Keeps the first error of parallel workers. */
#ifndef FLUIDY_BASE_PARALLEL_ERROR_H
#define FLUIDY_BASE_PARALLEL_ERROR_H

#include <glib.h>
#include <stdbool.h>

/** Moves `failure` (may be NULL) into *first, or frees it if there is one already. Any thread.
 */
void fl_parallel_error_keep(GError **first, GError *failure);

/** After the parallel part: moves `first` to `error`. Returns: true if `first` is NULL. */
bool fl_parallel_error_propagate(GError **error, GError *first);

#endif
