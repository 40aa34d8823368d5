/* Files that a drawing refers to. */
#ifndef FLUIDY_SVG_REFERENCE_H
#define FLUIDY_SVG_REFERENCE_H

#include <stdbool.h>

/**
 * The real path of what `href` names in the file `from`, links followed, or where it would be.
 * *is_there: whether something is there. Returns: NULL if it names no file; to be freed.
 */
char *fl_reference_file(const char *from, const char *href, bool *is_there);

/** Returns: true if a real path is in the folder of the drawing or below it. */
bool fl_reference_is_inside(const char *drawing, const char *file);

#endif
