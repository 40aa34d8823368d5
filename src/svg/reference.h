/* Files that a drawing refers to. */
#ifndef FLUIDY_SVG_REFERENCE_H
#define FLUIDY_SVG_REFERENCE_H

#include <stdbool.h>

/**
 * The real path of what `href` names in the file `from`, links followed; to be freed with free().
 * *is_file: whether it names a file at all. Returns: NULL if it does not, or if none is there.
 */
char *fl_reference_file(const char *from, const char *href, bool *is_file);

#endif
