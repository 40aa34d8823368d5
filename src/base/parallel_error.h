/* Of several threads' errors, the first one is told. */
#ifndef FLUIDY_BASE_PARALLEL_ERROR_H
#define FLUIDY_BASE_PARALLEL_ERROR_H

#include <glib.h>
#include <stdbool.h>

/** Moves `mine` (may be NULL) into *first unless there is one already, else frees it. Any thread.
 */
void fl_parallel_error_keep(GError **first, GError *mine);

/** Afterwards: moves `first` to `error`. Returns: false; true if there was none. */
bool fl_parallel_error_tell(GError **error, GError *first);

#endif
