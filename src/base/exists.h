/* The error about files that exist and must not be replaced. */
#ifndef FLUIDY_BASE_EXISTS_H
#define FLUIDY_BASE_EXISTS_H

#include <fluidy/error.h>
#include <stdbool.h>

/** Sets FL_ERROR_EXISTS about a file. */
void fl_exists_error(GError **error, const char *path);

/** Returns: true if there is no such file; else false with FL_ERROR_EXISTS set. */
bool fl_check_not_exists(const char *path, GError **error);

#endif
