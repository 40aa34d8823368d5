/* Of several threads' errors, the first one is told. */
#ifndef FLUIDY_BASE_FIRST_ERROR_H
#define FLUIDY_BASE_FIRST_ERROR_H

#include <glib.h>
#include <stdbool.h>

/** Moves `mine` (may be NULL) into *first unless there is one already, else frees it. Any thread.
 */
void fl_keep_first_error(GError **first, GError *mine);

/** Afterwards: moves `first` to `error`. Returns: false; true if there was none. */
bool fl_tell_first_error(GError **error, GError *first);

#endif
