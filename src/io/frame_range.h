/* Frame ranges: "1001-1096", "1-96x2", "10-", "1,5,9", "12~1". */
#ifndef FLUIDY_IO_FRAME_RANGE_H
#define FLUIDY_IO_FRAME_RANGE_H

#include <fluidy/error.h>

/**
 * The numbers of a range, ascending and without repeats.
 *
 * first and last are the sequence's own; "10-" ends at last, and numbers beyond them are kept, so
 * that the caller can name the missing ones. "12~1" is 12 and its neighbours up to 1 away between
 * first and last; "~1" is in their middle. Returns: an array of int, to be unref'd; NULL
 * with FL_ERROR_USAGE, quoting the range.
 */
GArray *fl_range_parse(const char *range, int first, int last, GError **error);

#endif
