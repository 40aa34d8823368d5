/* Files that are not to be replaced unasked. */
#ifndef FLUIDY_BASE_EXISTS_H
#define FLUIDY_BASE_EXISTS_H

#include <fluidy/error.h>
#include <stdbool.h>

/** FL_ERROR_EXISTS about a file, in the one wording there is. */
void fl_exists_error(GError **error, const char *path);

/** Whether there is no file of this name; else false with FL_ERROR_EXISTS. */
bool fl_exists_not(const char *path, GError **error);

#endif
