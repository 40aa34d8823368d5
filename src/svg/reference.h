/* Files that a drawing refers to. */
#ifndef FLUIDY_SVG_REFERENCE_H
#define FLUIDY_SVG_REFERENCE_H

#include <stdbool.h>

/**
 * The real path, with links resolved, of the file that `href` in the file `from` names, even if it
 * does not exist. *is_there: true if it exists. Returns: NULL if href names no file; to be freed.
 */
char *fl_reference_file(const char *from, const char *href, bool *is_there);

/** Returns: true if a real path is in the folder of the drawing or in a folder below. */
bool fl_reference_is_inside(const char *drawing, const char *file);

#endif
