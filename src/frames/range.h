/* Frame ranges: "1001-1096", "1-96x2", "10-", "1,5,9". */
#ifndef FLUIDY_FRAMES_RANGE_H
#define FLUIDY_FRAMES_RANGE_H

#include <fluidy/error.h>

/**
 * The numbers of a range, ascending and without repeats.
 *
 * first and last are the film's own; "10-" ends at last, and numbers beyond them are kept, so that
 * the caller can say what is missing. Returns: an array of int, to be unref'd; NULL with
 * FL_ERROR_USAGE, quoting the range.
 */
GArray *fl_range_parse(const char *range, int first, int last, GError **error);

#endif
